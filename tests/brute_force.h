#ifndef MESHGROW_TESTS_BRUTE_FORCE_H
#define MESHGROW_TESTS_BRUTE_FORCE_H

#include <algorithm>
#include <cmath>
#include <limits>

#include "sized_facets.h"

/// References that share no code with the library: slow, in extended precision, without a tree.
namespace meshgrow::test {

using WideVec3 = Eigen::Matrix<long double, 3, 1>;

inline long double segment_distance(const WideVec3& a, const WideVec3& b, const WideVec3& p) {
  const WideVec3 ab = b - a;
  const long double length2 = ab.squaredNorm();
  long double s = 0.0L;
  if (length2 > 0.0L) {
    s = std::clamp(ab.dot(p - a) / length2, 0.0L, 1.0L);
  }
  return (a + s * ab - p).norm();
}

/// The triangle as a family of segments parallel to its side ab: the distance to segment t is
/// convex in t, and its minimum is found by sections. Accurate for every shape, also without any
/// area.
inline long double swept_triangle_distance(const WideVec3& a, const WideVec3& b, const WideVec3& c,
                                           const WideVec3& p) {
  const auto at = [&](long double t) {
    return segment_distance(a + t * (c - a), b + t * (c - b), p);
  };
  long double low = 0.0L;
  long double high = 1.0L;
  long double best = std::min(at(low), at(high));
  for (int i = 0; i < 110; ++i) {
    const long double first = low + (high - low) / 3.0L;
    const long double second = high - (high - low) / 3.0L;
    const long double at_first = at(first);
    const long double at_second = at(second);
    best = std::min({best, at_first, at_second});
    (at_first <= at_second ? high : low) = at_first <= at_second ? second : first;
  }
  return best;
}

/// The foot on the triangle's plane if it is inside, else the nearest of the three sides. Fast, but
/// not for triangles almost without area.
inline long double projected_triangle_distance(const WideVec3& a, const WideVec3& b,
                                               const WideVec3& c, const WideVec3& p) {
  const WideVec3 normal = (b - a).cross(c - a);
  const bool inside = normal.dot((b - a).cross(p - a)) >= 0.0L &&
                      normal.dot((c - b).cross(p - b)) >= 0.0L &&
                      normal.dot((a - c).cross(p - c)) >= 0.0L;
  if (inside && normal.norm() > 0.0L) {
    return std::abs(normal.dot(p - a)) / normal.norm();
  }
  return std::min(
      {segment_distance(a, b, p), segment_distance(b, c, p), segment_distance(c, a, p)});
}

/// Distance from p to the facet, whatever its shape.
inline long double reference_distance(const Facet& facet, const Vec3& p) {
  const WideVec3 a = facet.corners[0].cast<long double>();
  const WideVec3 b = facet.corners[1].cast<long double>();
  const WideVec3 c = facet.corners[2].cast<long double>();
  const WideVec3 q = p.cast<long double>();
  if (facet.corner_count == 1) {
    return (a - q).norm();
  }
  if (facet.corner_count == 2) {
    return segment_distance(a, b, q);
  }
  const long double longest2 =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  const bool has_area = (b - a).cross(c - a).norm() > 1e-3L * longest2;
  return has_area ? projected_triangle_distance(a, b, c, q) : swept_triangle_distance(a, b, c, q);
}

/// The smallest S0 + α · distance over all facets, or `upper_bound`, in extended precision.
inline double reference_size(const SizedFacets& facets, const Vec3& p,
                             double upper_bound = std::numeric_limits<double>::infinity()) {
  long double size = upper_bound;
  for (const SizedFacet& f : facets) {
    size = std::min(size, f.start_size + f.slope * reference_distance(f.facet, p));
  }
  return static_cast<double>(size);
}

/// The same by the library's own distances, which have tests of their own: fast enough for a
/// hundred million facets.
inline double brute_force_size(const SizedFacets& facets, const Vec3& p,
                               double upper_bound = std::numeric_limits<double>::infinity()) {
  double size = upper_bound;
  for (const SizedFacet& f : facets) {
    size = std::min(size, f.start_size + f.slope * distance(f.facet, p));
  }
  return size;
}

/// Largest coordinate: what rounding errors of distances are proportional to.
inline double coordinate_scale(const Facet& facet) {
  double scale = 0.0;
  for (const Vec3& corner : facet.corners) {
    scale = std::max(scale, corner.cwiseAbs().maxCoeff());
  }
  return scale;
}

}  // namespace meshgrow::test

#endif
