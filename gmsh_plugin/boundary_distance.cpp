#include "boundary_distance.h"

#include <limits>

#include "model_reader.h"
#include "start_sizes/fixed_start_sizes.h"

namespace meshgrow {

namespace {

/// Facets whose size at a point is the distance to them: they start next to 0 and grow at slope 1.
SizedFacets distance_facets(const std::vector<Entity>& volumes, const Topology& topology) {
  constexpr double from = std::numeric_limits<double>::min();
  constexpr double slope = 1.0 - std::numeric_limits<double>::epsilon();
  const NodeCoordinates nodes;
  SizedFacets facets;
  for (const Entity& entity : topology.closure(volumes)) {
    if (entity.dim == 2) {
      append_fixed_start_sizes(read_entity_mesh(entity, nodes), from, slope, facets);
    }
  }
  return facets;
}

}  // namespace

BoundaryDistance::BoundaryDistance(const std::vector<Entity>& volumes, const Topology& topology)
    : tree_(distance_facets(volumes, topology)) {}

}  // namespace meshgrow
