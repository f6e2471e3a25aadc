#ifndef MESHGROW_FACET_H
#define MESHGROW_FACET_H

#include <array>

#include "geometry.h"

namespace meshgrow {

/// One piece of a faceted source: a point, a segment or a triangle, by its corners (model units).
/// Degenerate facets (coincident or collinear corners) are allowed everywhere.
struct Facet {
  std::array<Vec3, 3> corners;
  int corner_count = 3;  ///< 1, 2 or 3

  static Facet point(const Vec3& a) { return {{a, a, a}, 1}; }
  static Facet segment(const Vec3& a, const Vec3& b) { return {{a, b, b}, 2}; }
  static Facet triangle(const Vec3& a, const Vec3& b, const Vec3& c) { return {{a, b, c}, 3}; }

  friend bool operator==(const Facet& a, const Facet& b) {
    return a.corner_count == b.corner_count && a.corners == b.corners;
  }

  Box box() const;
  Vec3 centroid() const;
  /// Largest distance of a corner from the centroid.
  double radius() const;
};

/// The point of the facet closest to p. Always lies on the facet up to rounding, so the distance to
/// it is never too small by more than rounding. Thread-safe.
Vec3 closest_point(const Facet& facet, const Vec3& p);

/// Distance from p to the facet (clamped projection), model units. Thread-safe.
double distance(const Facet& facet, const Vec3& p);

/// Distance along the ray from `origin` in the unit vector `direction` to the triangle, borders
/// included; infinite where it misses, runs within the triangle's plane, or for other facets.
/// Thread-safe.
double ray_distance(const Facet& facet, const Vec3& origin, const Vec3& direction);

}  // namespace meshgrow

#endif
