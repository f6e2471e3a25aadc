#include "geometry_curvature.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gmsh_api.h"

namespace meshgrow {

namespace {

/// Inverse radius of the circle through three points.
double circle_curvature(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double product = (b - a).norm() * (c - b).norm() * (c - a).norm();
  return product > 0.0 ? 2.0 * (b - a).cross(c - b).norm() / product : 0.0;
}

/// Largest absolute principal curvature from differences of point and normal along u and v.
double largest_curvature(const Vec3& point_u, const Vec3& point_v, const Vec3& normal_u,
                         const Vec3& normal_v) {
  // A direction along u and one square to it, so that the unequal scales of u and v do not matter.
  const double length_u = point_u.norm();
  const Vec3 along = point_u / length_u;
  const double slant = along.dot(point_v);
  const Vec3 rest = point_v - slant * along;
  const double length_v = rest.norm();
  const Vec3 across = rest / length_v;
  const Vec3 normal_along = normal_u / length_u;
  const Vec3 normal_across = (normal_v - slant * normal_along) / length_v;
  const double a = normal_along.dot(along);
  const double b = 0.5 * (normal_along.dot(across) + normal_across.dot(along));
  const double c = normal_across.dot(across);
  const double radius = std::hypot(0.5 * (a - c), b);
  const double curvature = std::abs(0.5 * (a + c)) + radius;
  return std::isfinite(curvature) ? curvature : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<double> curve_curvatures(const Entity& curve, const std::vector<double>& parameters,
                                     const std::vector<double>& steps) {
  if (parameters.empty()) {
    return {};
  }
  std::vector<double> around;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    around.insert(around.end(),
                  {parameters[i] - steps[i], parameters[i], parameters[i] + steps[i]});
  }
  const std::vector<Vec3> points = gmsh::points_at(curve, around);
  std::vector<double> result;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    result.push_back(circle_curvature(points[3 * i], points[3 * i + 1], points[3 * i + 2]));
  }
  return result;
}

std::vector<double> surface_curvatures(const Entity& surface, const std::vector<double>& parameters,
                                       const std::vector<double>& steps) {
  if (parameters.empty()) {
    return {};
  }
  std::vector<double> around;
  around.reserve(4 * parameters.size());
  for (std::size_t i = 0; i < parameters.size(); i += 2) {
    const double u = parameters[i];
    const double v = parameters[i + 1];
    const double du = steps[i];
    const double dv = steps[i + 1];
    around.insert(around.end(), {u - du, v, u + du, v, u, v - dv, u, v + dv});
  }
  const std::vector<Vec3> points = gmsh::points_at(surface, around);
  const std::vector<Vec3> normals = gmsh::normals_at(surface, around);
  std::vector<double> result;
  result.reserve(parameters.size() / 2);
  for (std::size_t i = 0; i + 3 < points.size(); i += 4) {
    result.push_back(largest_curvature(points[i + 1] - points[i], points[i + 3] - points[i + 2],
                                       normals[i + 1] - normals[i],
                                       normals[i + 3] - normals[i + 2]));
  }
  return result;
}

}  // namespace meshgrow
