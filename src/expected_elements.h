#ifndef MESHGROW_EXPECTED_ELEMENTS_H
#define MESHGROW_EXPECTED_ELEMENTS_H

#include "sized_facets.h"
#include "stored_array.h"

namespace meshgrow {

/// About how many tetrahedra a volume in the box gets whose sizes grow from the facets up to the
/// limit: the integral of 1 / size³, over what lies above one side of each facet. Within a factor
/// of two around one surface; too many where facets overlap in what they rule.
double expected_tetrahedra(const StoredArray<SizedFacet>& facets, double size_limit,
                           const Box& box);

}  // namespace meshgrow

#endif
