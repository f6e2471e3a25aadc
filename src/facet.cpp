#include "facet.h"

#include <algorithm>

namespace meshgrow {

namespace {

Vec3 closest_on_segment(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 ab = b - a;
  const double length2 = ab.squaredNorm();
  if (!(length2 > 0.0)) {
    return a;
  }
  const double s = ab.dot(p - a) / length2;
  // The far end is returned itself, not a + 1·ab, which may differ from b in the last bit.
  return s <= 0.0 ? a : s >= 1.0 ? b : Vec3(a + s * ab);
}

Vec3 nearest_of(const Vec3& q1, const Vec3& q2, const Vec3& p) {
  return (q1 - p).squaredNorm() <= (q2 - p).squaredNorm() ? q1 : q2;
}

Vec3 closest_on_sides(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 best = nearest_of(closest_on_segment(a, b, p), closest_on_segment(a, c, p), p);
  return nearest_of(best, closest_on_segment(b, c, p), p);
}

/// Decomposes p − a along the longest side and along the height upon it. Both directions are
/// accurate for needles and slivers, too, where the usual 2 × 2 system loses all its digits.
Vec3 closest_on_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const double ab2 = (b - a).squaredNorm();
  const double bc2 = (c - b).squaredNorm();
  const double ca2 = (a - c).squaredNorm();
  if (bc2 > ab2 && bc2 >= ca2) {
    return closest_on_triangle(b, c, a, p);
  }
  if (ca2 > ab2) {
    return closest_on_triangle(c, a, b, p);
  }
  const Vec3 side = b - a;
  const double foot = side.dot(c - a) / ab2;
  Vec3 height = (c - a) - foot * side;
  height -= (height.dot(side) / ab2) * side;
  const double height2 = height.squaredNorm();
  if (height2 > 0.0) {
    const double t = height.dot(p - a) / height2;
    const double s = side.dot(p - a) / ab2;
    if (t >= 0.0 && t <= 1.0 && s >= t * foot && s <= 1.0 - t * (1.0 - foot)) {
      return a + s * side + t * height;
    }
  }
  return closest_on_sides(a, b, c, p);
}

}  // namespace

Box Facet::box() const {
  Box box;
  for (int i = 0; i < corner_count; ++i) {
    box.extend(corners[i]);
  }
  return box;
}

Vec3 Facet::centroid() const {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < corner_count; ++i) {
    sum += corners[i];
  }
  return sum / corner_count;
}

Vec3 closest_point(const Facet& facet, const Vec3& p) {
  const auto& [a, b, c] = facet.corners;
  switch (facet.corner_count) {
    case 1:
      return a;
    case 2:
      return closest_on_segment(a, b, p);
    default:
      return closest_on_triangle(a, b, c, p);
  }
}

double distance(const Facet& facet, const Vec3& p) { return (closest_point(facet, p) - p).norm(); }

}  // namespace meshgrow
