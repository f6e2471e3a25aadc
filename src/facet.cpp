#include "facet.h"

#include <algorithm>
#include <limits>

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

/// A point relative to the origin of a ray, projected along the ray onto a coordinate plane (Woop,
/// Benthin, Wald: Watertight ray/triangle intersection, JCGT 2013). All triangles at a corner see
/// it in the same place, to the bit.
struct SeenAlong {
  double x;
  double y;
  double depth;  ///< distance along the ray

  SeenAlong(const Vec3& p, const Vec3& direction) {
    int axis = 0;
    direction.cwiseAbs().maxCoeff(&axis);
    depth = p[axis] / direction[axis];
    x = p[(axis + 1) % 3] - depth * direction[(axis + 1) % 3];
    y = p[(axis + 2) % 3] - depth * direction[(axis + 2) % 3];
  }
};

/// Twice the area that two points span with the ray. Its sign is right or it is 0, as the rounding
/// of products keeps their order, whatever the compiler makes of their difference: so no ray slips
/// between triangles that share a side or a corner.
double turn(const SeenAlong& a, const SeenAlong& b) {
  const double forward = a.x * b.y;
  const double backward = a.y * b.x;
  return forward == backward ? 0.0 : forward - backward;
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

double Facet::radius() const {
  const Vec3 centre = centroid();
  double radius = 0.0;
  for (int i = 0; i < corner_count; ++i) {
    radius = std::max(radius, (corners[i] - centre).norm());
  }
  return radius;
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

double ray_distance(const Facet& facet, const Vec3& origin, const Vec3& direction) {
  constexpr double miss = std::numeric_limits<double>::infinity();
  if (facet.corner_count != 3) {
    return miss;
  }
  const SeenAlong a(facet.corners[0] - origin, direction);
  const SeenAlong b(facet.corners[1] - origin, direction);
  const SeenAlong c(facet.corners[2] - origin, direction);
  const double u = turn(c, b);
  const double v = turn(a, c);
  const double w = turn(b, a);
  if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) {
    return miss;
  }
  const double sum = u + v + w;
  if (sum == 0.0) {
    return miss;
  }
  const double distance = (u * a.depth + v * b.depth + w * c.depth) / sum;
  return distance >= 0.0 ? distance : miss;
}

}  // namespace meshgrow
