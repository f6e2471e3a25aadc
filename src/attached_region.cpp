#include "attached_region.h"

#include <cmath>

namespace meshgrow {

namespace {

/// The size at a point is the distance: from next to 0 at slope 1.
SizedFacets distance_facets(const std::vector<std::array<Vec3, 3>>& triangles) {
  SizedFacets facets;
  facets.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) {
    facets.push_back({Facet::triangle(a, b, c), 0.0, 1.0});
  }
  return facets;
}

}  // namespace

AttachedRegion::AttachedRegion(const std::vector<std::array<Vec3, 3>>& triangles, int threads)
    : boundary_(distance_facets(triangles), threads) {}

bool AttachedRegion::touches(const Vec3& centre, double radius) const {
  // A little more, for the rounding of cells and of distances.
  const double reach = 1.001 * radius;
  return boundary_.size(centre, reach) < reach;
}

/// From outside a ray meets boundaries an even number of times.
bool AttachedRegion::encloses(const Vec3& p) const {
  // Along no axis and no diagonal, so that it hardly ever runs within a face or through an edge.
  const Vec3 direction = Vec3(0.5128, 0.7013, 0.4951).normalized();
  return crossings(p, direction, FacetTree::infinity) % 2 == 1;
}

bool AttachedRegion::separates(const Vec3& p, const Vec3& q) const {
  const double distance = (q - p).norm();
  return distance > 0.0 && crossings(p, (q - p) / distance, distance) % 2 == 1;
}

std::size_t AttachedRegion::crossings(const Vec3& from, const Vec3& direction,
                                      double within) const {
  std::size_t count = 0;
  const Vec3 inverse = direction.cwiseInverse();
  boundary_.closest_facet(
      within,
      [&](std::size_t, const Box& box) { return FacetTree::ray_enters(box, from, inverse); },
      [&](std::uint32_t i) {
        count += ray_distance(boundary_.facets()[i].facet, from, direction) < within ? 1 : 0;
        return FacetTree::infinity;  // on to the next
      });
  return count;
}

}  // namespace meshgrow
