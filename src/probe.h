#ifndef MESHGROW_PROBE_H
#define MESHGROW_PROBE_H

#include <cstddef>
#include <limits>
#include <optional>

#include "entity.h"
#include "sized_facets.h"

namespace meshgrow {

/// What decides the exact size at a point of an entity.
enum class Rule {
  nothing,       ///< no size function acts, or the point is not finite
  facet,         ///< a facet of a source, from which the size grows
  limit,         ///< the size limit of a function
  inside_source  ///< the entity is in a source volume of a fixed function, which has one size
};

/// The size at a point and where it comes from. Lengths in model units.
struct Probe {
  Entity entity;
  double size = std::numeric_limits<double>::infinity();        ///< what is answered
  double exact_size = std::numeric_limits<double>::infinity();  ///< without a grid
  /// What the background grid answers; not a number where there is none.
  double grid_size = std::numeric_limits<double>::quiet_NaN();
  Rule rule = Rule::nothing;
  std::size_t function = 0;  ///< index of the function that decides, unless `nothing` does

  // If a facet decides; of several that ask for the same size, one of them.
  std::optional<Entity> source;  ///< the entity that it is of, where that is known
  SizedFacet facet;
  double distance = 0.0;  ///< from the point to the facet
};

}  // namespace meshgrow

#endif
