#ifndef MESHGROW_FACET_BLOCK_H
#define MESHGROW_FACET_BLOCK_H

#include <cstdint>

#include "simd/wide_tree.h"
#include "sized_facets.h"

namespace meshgrow {

/// In units of a block; what is larger counts as this where float rules facets out. An infinite
/// start size stands for no facet.
constexpr double largest_start_size = 1e30;

/// Puts a facet into a lane of a block whose origin is given in model units; `unit` is that of the
/// block's lengths and sizes. Returns the normal of a triangle, as long as twice its area; a
/// segment itself; both in units of the block.
Vec3 set_facet(simd::FacetBlock& block, std::uint32_t lane, const SizedFacet& sized,
               const Vec3& origin, double unit);

}  // namespace meshgrow

#endif
