#include "boundary_distance.h"

#include <limits>

#include "model_reader.h"

namespace meshgrow {

namespace {

/// Facets whose size at a point is the distance to them: they start next to 0 and grow at slope 1.
SizedFacets distance_facets(const std::vector<Entity>& volumes, const Topology& topology) {
  constexpr double from = std::numeric_limits<double>::min();
  constexpr double slope = 1.0 - std::numeric_limits<double>::epsilon();
  const NodeCoordinates nodes;
  SizedFacets facets;
  DroppedFacets dropped;
  for (const Entity& entity : topology.closure(volumes)) {
    if (entity.dim != 2) {
      continue;
    }
    const FacetedSource mesh = read_entity_mesh(entity, nodes);
    for (const auto& [a, b, c] : mesh.triangles) {
      append_facet(Facet::triangle(a, b, c), from, slope, facets, dropped);
    }
    for (const auto& quad : mesh.quads) {
      for (const Facet& half : split_quad(quad)) {
        append_facet(half, from, slope, facets, dropped);
      }
    }
  }
  return facets;
}

}  // namespace

BoundaryDistance::BoundaryDistance(const std::vector<Entity>& volumes, const Topology& topology)
    : tree_(distance_facets(volumes, topology)) {}

}  // namespace meshgrow
