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

/// Along no axis and no diagonal, so that it hardly ever runs within a face.
Vec3 direction_of_sight() { return Vec3(0.5128, 0.7013, 0.4951).normalized(); }

}  // namespace

AttachedRegion::AttachedRegion(std::vector<std::array<Vec3, 3>> triangles, int threads)
    : boundary_(distance_facets(triangles), threads) {}

AttachedRegion::Place AttachedRegion::place(const Vec3& centre, double radius) const {
  // A little more, for the rounding of cells and of distances.
  const double reach = 1.001 * radius;
  if (boundary_.size(centre, reach) < reach) {
    return Place::boundary;
  }
  return encloses(centre) ? Place::inside : Place::outside;
}

/// From outside a ray meets boundaries an even number of times. No ray slips between triangles that
/// share a side (facet.h), but it may meet both of them: so two rays must agree on an even number.
bool AttachedRegion::encloses(const Vec3& p) const {
  for (const Vec3& direction : {direction_of_sight(), Vec3(-direction_of_sight())}) {
    std::size_t crossings = 0;
    boundary_.first_hit(p, direction, FacetTree::infinity, [&crossings](std::uint32_t) {
      ++crossings;
      return false;  // on to the next
    });
    if (crossings % 2 == 1) {
      return true;
    }
  }
  return false;
}

}  // namespace meshgrow
