#include "shape_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "error.h"
#include "surface_triangulator.h"

namespace meshgrow {

namespace {

constexpr int intervals_at_first = 4;
constexpr int most_halvings = 10;

/// The pole of a sphere or the tip of a cone.
bool is_one_point(const std::vector<Vec3>& points) {
  double scale = 0.0;
  double length = 0.0;
  for (const Vec3& point : points) {
    scale = std::max(scale, point.cwiseAbs().maxCoeff());
    length = std::max(length, (point - points.front()).norm());
  }
  return length <= 1e-9 * scale;
}

/// What must not turn much along a curve: its tangent and the normals of surfaces on it.
std::vector<std::vector<Vec3>> directions_along(const Entity& curve,
                                                const std::vector<double>& parameters,
                                                const std::vector<Entity>& surfaces) {
  const std::vector<Vec3> points = gmsh::points_at(curve, parameters);
  std::vector<std::vector<Vec3>> result;
  if (!is_one_point(points)) {
    result.push_back(gmsh::derivatives_at(curve, parameters));
  }
  for (const Entity& surface : surfaces) {
    try {
      const std::vector<double> uv = gmsh::parameters_on_surface(curve, parameters, surface, false);
      result.push_back(normals_along(surface, uv, points));
    } catch (const Error&) {
      // A surface that does not know this curve has no say.
    }
  }
  return result;
}

/// On a round surface that is cut off at its seam, Gmsh has some borders a full turn away from the
/// others. These are turned back.
void turn_into_range(const Entity& surface, std::vector<double>& uv) {
  constexpr double tolerance = 1e-3;  // in parts of the range
  const double full_turn = 2.0 * std::acos(-1.0);
  const auto bounds = gmsh::parameter_bounds(surface);
  for (std::size_t axis = 0; axis < bounds.size(); ++axis) {
    const auto [low, high] = bounds[axis];
    const double margin = tolerance * (high - low);
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (std::size_t i = axis; i < uv.size(); i += 2) {
      least = std::min(least, uv[i]);
      most = std::max(most, uv[i]);
    }
    const double turn = most > high + margin ? -full_turn : least < low - margin ? full_turn : 0.0;
    if (turn == 0.0 || least + turn < low - margin || most + turn > high + margin) {
      continue;
    }
    std::vector<double> turned = uv;
    for (std::size_t i = axis; i < uv.size(); i += 2) {
      turned[i] += turn;
    }
    const std::vector<Vec3> here = gmsh::points_at(surface, uv);
    const std::vector<Vec3> there = gmsh::points_at(surface, turned);
    double apart = 0.0;
    double scale = 0.0;
    for (std::size_t i = 0; i < here.size(); ++i) {
      apart = std::max(apart, (there[i] - here[i]).norm());
      scale = std::max(scale, here[i].norm());
    }
    if (apart <= 1e-6 * scale) {  // else the surface is not round this way
      uv = std::move(turned);
    }
  }
}

}  // namespace

std::vector<Vec3> normals_along(const Entity& surface, const std::vector<double>& uv,
                                const std::vector<Vec3>& points) {
  constexpr double inwards = 0.001;  // in parts of the range
  if (!is_one_point(points)) {
    return gmsh::normals_at(surface, uv);
  }
  const auto bounds = gmsh::parameter_bounds(surface);
  std::vector<double> at = uv;
  for (std::size_t i = 0; i < at.size() && bounds.size() == 2; ++i) {
    const auto [low, high] = bounds[i % 2];
    at[i] += inwards * (0.5 * (low + high) - at[i]);
  }
  return gmsh::normals_at(surface, at);
}

double turn_between(const Vec3& a, const Vec3& b) {
  const double degrees = std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::acos(-1.0);
  return std::isfinite(degrees) && a.squaredNorm() > 0.0 && b.squaredNorm() > 0.0 ? degrees : 0.0;
}

ShapeSampler::ShapeSampler(const Topology& topology, double max_turn)
    : topology_(topology), max_turn_(max_turn) {
  for (const Entity& surface : topology.entities(2)) {
    for (const Entity& lower : topology.lower(surface)) {
      if (lower.dim == 1) {
        surfaces_on_[lower].push_back(surface);
      }
    }
  }
}

Vec3 ShapeSampler::end_point(const Entity& curve, const Vec3& computed) const {
  // Curves that meet agree in the point of the model, not in what their parametrisations give.
  Vec3 nearest = computed;
  double distance = std::numeric_limits<double>::infinity();
  for (const Entity& lower : topology_.lower(curve)) {
    const Vec3 point = gmsh::points_at(lower, {})[0];
    if ((point - computed).norm() < distance) {
      distance = (point - computed).norm();
      nearest = point;
    }
  }
  return nearest;
}

const SampledCurve& ShapeSampler::curve(const Entity& curve) {
  const auto known = curves_.find(curve);
  if (known != curves_.end()) {
    return known->second;
  }
  const auto bounds = gmsh::parameter_bounds(curve);
  if (bounds.size() != 1) {
    throw Error(entity_name(curve) + " has neither a mesh nor a parametrisation: mesh it first.");
  }
  const auto [low, high] = bounds[0];
  std::vector<double> parameters;
  for (int i = 0; i <= intervals_at_first; ++i) {
    parameters.push_back(low + (high - low) * i / intervals_at_first);
  }
  const std::vector<Entity> surfaces = surfaces_on_[curve];
  for (int halving = 0; halving < most_halvings; ++halving) {
    // With the middle of each interval, or a turn and its return would cancel out.
    std::vector<double> halved;
    for (std::size_t i = 0; i + 1 < parameters.size(); ++i) {
      halved.push_back(parameters[i]);
      halved.push_back(0.5 * (parameters[i] + parameters[i + 1]));
    }
    halved.push_back(parameters.back());
    const auto directions = directions_along(curve, halved, surfaces);
    std::vector<double> next;
    for (std::size_t i = 0; i + 2 < halved.size(); i += 2) {
      next.push_back(halved[i]);
      if (std::any_of(directions.begin(), directions.end(), [&](const std::vector<Vec3>& along) {
            return turn_between(along[i], along[i + 2]) > max_turn_ ||
                   turn_between(along[i], along[i + 1]) > 0.75 * max_turn_;
          })) {
        next.push_back(halved[i + 1]);
      }
    }
    next.push_back(halved.back());
    if (next.size() == parameters.size()) {
      break;
    }
    parameters = std::move(next);
  }
  const auto directions = directions_along(curve, parameters, surfaces);
  if (std::all_of(directions.begin(), directions.end(), [](const std::vector<Vec3>& along) {
        return std::all_of(along.begin(), along.end(), [&along](const Vec3& direction) {
          return turn_between(along.front(), direction) < 1e-6;
        });
      })) {
    parameters = {low, high};
  }
  SampledCurve sampled{parameters, gmsh::points_at(curve, parameters)};
  sampled.points.front() = end_point(curve, sampled.points.front());
  sampled.points.back() = end_point(curve, sampled.points.back());
  if (is_one_point(sampled.points)) {
    std::fill(sampled.points.begin(), sampled.points.end(), sampled.points.front());
  }
  return curves_.emplace(curve, std::move(sampled)).first->second;
}

std::vector<CurveOnSurface> ShapeSampler::curves_on(const Entity& surface) {
  std::vector<CurveOnSurface> curves;
  std::set<Entity> met;
  for (const Entity& border : gmsh::boundary(surface)) {
    const bool other_side = !met.insert(border).second;
    const SampledCurve& sampled = curve(border);
    std::vector<double> uv =
        gmsh::parameters_on_surface(border, sampled.parameters, surface, other_side);
    turn_into_range(surface, uv);
    curves.push_back({std::move(uv), sampled.points, true});
  }
  for (const Entity& embedded : gmsh::embedded(surface)) {
    if (embedded.dim == 1) {
      const SampledCurve& sampled = curve(embedded);
      std::vector<double> coordinates;
      for (const Vec3& point : sampled.points) {
        coordinates.insert(coordinates.end(), {point.x(), point.y(), point.z()});
      }
      curves.push_back({gmsh::parameters_at(surface, coordinates), sampled.points, false});
    }
  }
  return curves;
}

std::optional<SampledSurface> ShapeSampler::surface(const Entity& surface) {
  try {
    SurfaceTriangulator triangulator(surface, curves_on(surface), max_turn_);
    triangulator.refine();
    SampledSurface result = triangulator.result();
    return result.triangles.empty() ? std::nullopt : std::make_optional(std::move(result));
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace meshgrow
