#ifndef MESHGROW_START_SIZES_MESH_START_SIZES_H
#define MESHGROW_START_SIZES_MESH_START_SIZES_H

#include "faceted_source.h"
#include "sized_facets.h"

namespace meshgrow {

/// Initialization of a mesh size function (paper, section 3): each element of the source becomes a
/// facet whose start size is the element's own size. Appends to `facets`; thread-safe on different
/// outputs.
DroppedFacets append_mesh_start_sizes(const FacetedSource& source, QuadSize quad_size, double slope,
                                      SizedFacets& facets);

}  // namespace meshgrow

#endif
