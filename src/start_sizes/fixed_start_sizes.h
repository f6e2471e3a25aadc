#ifndef MESHGROW_START_SIZES_FIXED_START_SIZES_H
#define MESHGROW_START_SIZES_FIXED_START_SIZES_H

#include "faceted_source.h"
#include "sized_facets.h"

namespace meshgrow {

/// Initialization of a fixed size function: every piece of the source has the given start size
/// (model units). Appends to `facets`; thread-safe on different outputs.
DroppedFacets append_fixed_start_sizes(const FacetedSource& source, double start_size, double slope,
                                       SizedFacets& facets);

}  // namespace meshgrow

#endif
