#include "discrete_curvature.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "node_numbers.h"

namespace meshgrow {
namespace {

using Index = std::int32_t;
constexpr Index none = -1;
constexpr double degree = 3.14159265358979323846 / 180.0;
// With slack for regular polygons that turn by just this much.
const double crease_cosine = std::cos(crease_angle * degree) - 1e-6;

// ==== Points

/// The number of the point at each corner of all facets in turn.
template <std::size_t corner_count>
std::vector<Index> point_numbers(const std::vector<std::array<Vec3, corner_count>>& facets) {
  NodeNumbers numbers;
  std::vector<Index> points;
  points.reserve(facets.size() * corner_count);
  for (const auto& facet : facets) {
    for (const Vec3& corner : facet) {
      points.push_back(static_cast<Index>(numbers.of(corner)));
    }
  }
  return points;
}

// ==== Curves

/// One over the radius of the circle through the ends of two segments that follow each other
/// (Menger); 0 where they turn too much.
double turn_curvature(const Vec3& before, const Vec3& after) {
  const Vec3 from = before.normalized();
  const Vec3 to = after.normalized();
  const bool smooth = from.dot(to) >= crease_cosine;
  return smooth ? 2.0 * from.cross(to).norm() / (before + after).norm() : 0.0;
}

// ==== Surfaces

/// Corner 3 t + i is corner i of triangle t; the edge of the same number goes from it to the next.
Index next_corner(Index corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
Index previous_corner(Index corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

/// A corner of a triangle on the way around its point. The triangle's own normal times `sign` is on
/// the side of the way's; the way leaves over the edge to the previous corner, or with sign -1 to
/// the next.
struct Step {
  Index corner;
  int sign;
};

/// The triangles around one point that are connected over smooth edges.
struct Fan {
  Vec3 normal;         ///< zero at the tip of a cone: each triangle has its own there
  Step start;          ///< at the first of its two bounding edges
  double angle = 0.0;  ///< of all its triangles together, where not closed
  bool closed = false;
};

class FacetedSurface {
 public:
  explicit FacetedSurface(const std::vector<std::array<Vec3, 3>>& triangles)
      : triangles_(triangles), points_(point_numbers(triangles)) {
    find_normals();
    find_smooth_edges();
    find_fans();
    for (int pass = 0; pass < 3; ++pass) {
      straighten_open_fans();
    }
  }

  double curvature(std::size_t triangle) const;

 private:
  const Vec3& position(Index corner) const { return triangles_[corner / 3][corner % 3]; }
  Vec3 spoke(Index corner, bool outgoing) const {
    return position(outgoing ? next_corner(corner) : previous_corner(corner)) - position(corner);
  }
  bool has_normal(std::size_t triangle) const { return normals_[triangle] != Vec3::Zero(); }

  void find_normals();
  void find_smooth_edges();
  void join_if_smooth(Index edge, Index other);
  void find_fans();
  void walk_fan(Fan& fan);
  void straighten_open_fans();
  Vec3 straightened_normal(const Fan& fan) const;

  Step step(Step from) const;
  Fan fan_around(Index corner) const;
  double angle_at(Index corner) const;
  double weight_at(Index corner) const;
  bool continues_beyond(Index corner, bool outgoing) const;
  Vec3 normal_at(Index corner) const;

  const std::vector<std::array<Vec3, 3>>& triangles_;
  std::vector<Index> points_;  ///< of each corner
  std::vector<Vec3> normals_;  ///< of each triangle; zero where degenerate
  std::vector<Index> across_;  ///< of each edge the same edge in the other triangle, if smooth
  std::vector<Fan> fans_;
  std::vector<Index> fan_of_;      ///< of each corner
  std::vector<signed char> sign_;  ///< of each corner's triangle in that fan
  std::vector<float> fan_angle_;   ///< from the fan's start to each corner's triangle
};

void FacetedSurface::find_normals() {
  // Below this height over the largest coordinate a normal is nothing but rounding.
  constexpr double smallest_height = 1e-13;
  normals_.assign(triangles_.size(), Vec3::Zero());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [a, b, c] = triangles_[t];
    const Vec3 doubled_area = (b - a).cross(c - a);
    const double length = doubled_area.norm();
    const double longest =
        std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    const double extent = a.cwiseAbs().cwiseMax(b.cwiseAbs()).cwiseMax(c.cwiseAbs()).maxCoeff();
    if (std::isfinite(length) && length > smallest_height * extent * longest) {
      normals_[t] = doubled_area / length;
    }
  }
}

void FacetedSurface::find_smooth_edges() {
  std::vector<std::pair<std::uint64_t, Index>> edges;  // by both of their points
  edges.reserve(points_.size());
  for (std::size_t corner = 0; corner < points_.size(); ++corner) {
    if (has_normal(corner / 3)) {
      const Index edge = static_cast<Index>(corner);
      const auto [low, high] = std::minmax({points_[edge], points_[next_corner(edge)]});
      edges.emplace_back(static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high),
                         edge);
    }
  }
  std::sort(edges.begin(), edges.end());
  across_.assign(points_.size(), none);
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    while (end < edges.size() && edges[end].first == edges[i].first) {
      ++end;
    }
    if (end - i == 2) {
      join_if_smooth(edges[i].second, edges[i + 1].second);
    }
  }
}

void FacetedSurface::join_if_smooth(Index edge, Index other) {
  const double sign = points_[edge] == points_[other] ? -1.0 : 1.0;
  if (sign * normals_[edge / 3].dot(normals_[other / 3]) >= crease_cosine) {
    across_[edge] = other;
    across_[other] = edge;
  }
}

/// Corner `none` where there is an end.
Step FacetedSurface::step(Step from) const {
  const Index edge = across_[from.sign > 0 ? previous_corner(from.corner) : from.corner];
  if (edge == none) {
    return {none, 0};
  }
  const bool starts_here = points_[edge] == points_[from.corner];
  return starts_here ? Step{edge, 1} : Step{next_corner(edge), -1};
}

Fan FacetedSurface::fan_around(Index corner) const {
  Fan fan;
  fan.start = {corner, -1};
  for (;;) {
    const Step further = step(fan.start);
    if (further.corner == none || further.corner == corner) {
      fan.closed = further.corner == corner;
      break;
    }
    fan.start = further;
  }
  fan.start.sign = -fan.start.sign;
  return fan;
}

double FacetedSurface::angle_at(Index corner) const {
  const Vec3 out = spoke(corner, true);
  const Vec3 in = spoke(corner, false);
  return std::atan2(out.cross(in).norm(), out.dot(in));
}

/// Max, "Weights for computing vertex normals from facet normals" (1999): exact on a sphere, and on
/// a cylinder with strips of any width.
double FacetedSurface::weight_at(Index corner) const {
  const Vec3 out = spoke(corner, true);
  const Vec3 in = spoke(corner, false);
  return (out / out.squaredNorm()).cross(in / in.squaredNorm()).norm();
}

void FacetedSurface::find_fans() {
  fan_of_.assign(points_.size(), none);
  sign_.assign(points_.size(), 0);
  fan_angle_.assign(points_.size(), 0.0F);
  fans_.reserve(points_.size() / 4);
  for (std::size_t corner = 0; corner < points_.size(); ++corner) {
    if (fan_of_[corner] == none && has_normal(corner / 3)) {
      fans_.push_back(fan_around(static_cast<Index>(corner)));
      walk_fan(fans_.back());
    }
  }
}

void FacetedSurface::walk_fan(Fan& fan) {
  const Index number = static_cast<Index>(&fan - fans_.data());
  fan.normal = Vec3::Zero();
  double weights = 0.0;
  for (Step at = fan.start; at.corner != none && fan_of_[at.corner] == none; at = step(at)) {
    fan_of_[at.corner] = number;
    sign_[at.corner] = static_cast<signed char>(at.sign);
    const double weight = weight_at(at.corner);
    fan.normal += at.sign * weight * normals_[at.corner / 3];
    weights += weight;
    if (!fan.closed) {
      fan_angle_[at.corner] = static_cast<float>(fan.angle);
      fan.angle += angle_at(at.corner);
    }
  }
  const double length = fan.normal.norm();
  fan.normal = length < crease_cosine * weights ? Vec3::Zero() : Vec3(fan.normal / length);
}

/// Whether the corner's fan has triangles on the other side of the point, too, seen from the
/// corner's outgoing or incoming edge: only then its normal does not lean along it.
bool FacetedSurface::continues_beyond(Index corner, bool outgoing) const {
  constexpr double opposite = 165.0 * degree;
  const Fan& fan = fans_[fan_of_[corner]];
  if (fan.closed) {
    return true;
  }
  const bool entering = outgoing == (sign_[corner] > 0);
  const double at = fan_angle_[corner] + (entering ? 0.0 : angle_at(corner));
  return std::max(at, fan.angle - at) >= opposite;
}

Vec3 FacetedSurface::straightened_normal(const Fan& fan) const {
  constexpr double least_change = 1e-2;  // decides where the edges say nothing
  Eigen::Matrix3d matrix = least_change * Eigen::Matrix3d::Identity();
  Vec3 right_side = least_change * fan.normal;
  const auto add_edge = [&](Index corner, bool outgoing) {
    const Index other = outgoing ? next_corner(corner) : previous_corner(corner);
    const Vec3& normal = fans_[fan_of_[other]].normal;
    if (normal != Vec3::Zero() && continues_beyond(other, !outgoing)) {
      const Vec3 along = spoke(corner, outgoing).normalized();
      matrix += along * along.transpose();
      right_side -= sign_[corner] * sign_[other] * along.dot(normal) * along;
    }
  };
  add_edge(fan.start.corner, fan.start.sign > 0);
  for (Step at = fan.start; at.corner != none; at = step(at)) {
    add_edge(at.corner, at.sign < 0);
  }
  return matrix.llt().solve(right_side).normalized();
}

/// A fan with triangles on one side only has a normal that leans to it. But on a cylinder, a sphere
/// or a paraboloid, edges are as steep against the normal at one end as at the other:
/// (n_a + n_b) . (b - a) = 0. From ends that do not lean this way it gives the normals of the rest;
/// as those help each other along borders, a few passes do better than one.
void FacetedSurface::straighten_open_fans() {
  std::vector<std::pair<Index, Vec3>> changed;
  for (std::size_t i = 0; i < fans_.size(); ++i) {
    if (!fans_[i].closed && fans_[i].normal != Vec3::Zero()) {
      changed.emplace_back(static_cast<Index>(i), straightened_normal(fans_[i]));
    }
  }
  for (const auto& [fan, normal] : changed) {
    fans_[fan].normal = normal;
  }
}

Vec3 FacetedSurface::normal_at(Index corner) const {
  const Vec3& normal = fans_[fan_of_[corner]].normal;
  return normal == Vec3::Zero() ? normals_[corner / 3] : Vec3(sign_[corner] * normal);
}

/// Rusinkiewicz, "Estimating curvatures and their derivatives on triangle meshes" (2004), solved in
/// the frame of the longest edge, where it stays well conditioned for needles.
double FacetedSurface::curvature(std::size_t triangle) const {
  if (!has_normal(triangle)) {
    return 0.0;
  }
  const Index base = static_cast<Index>(3 * triangle);
  const auto length = [&](Index corner) { return spoke(corner, true).norm(); };
  Index a = base;
  for (const Index corner : {base + 1, base + 2}) {
    a = length(corner) > length(a) ? corner : a;
  }
  const Index b = next_corner(a);
  const Index c = next_corner(b);
  const Vec3 x = spoke(a, true).normalized();
  const Vec3 y = normals_[triangle].cross(x);
  const double width = length(a);
  const double foot = -spoke(c, true).dot(x);
  const double height = -spoke(c, true).dot(y);
  // Across a sliver the normals say nothing.
  constexpr double sliver = 0.2;
  const double depth = std::max(height, sliver * std::min(length(b), length(c)));
  const auto in_plane = [&](const Vec3& v) { return Eigen::Vector2d(v.dot(x), v.dot(y)); };
  const Eigen::Vector2d along = in_plane(normal_at(b) - normal_at(a)) / width;
  const Eigen::Vector2d across = (in_plane(normal_at(c) - normal_at(a)) - foot * along) / depth;
  // The symmetric form nearest to the gradient of the normals, which changes by `along` and
  // `across` per length: nearest as measured along the three edges, whose second moments these are.
  const double xx = width * width + foot * foot + (width - foot) * (width - foot);
  const double xy = (2.0 * foot - width) * height;
  const double yy = 2.0 * height * height;
  const double asymmetry = (across.x() - along.y()) / (xx + yy);
  const double first = along.x() + xy * asymmetry;
  const double second = across.y() - xy * asymmetry;
  const double twist = along.y() + yy * asymmetry;
  return std::abs(0.5 * (first + second)) + std::hypot(0.5 * (first - second), twist);
}

}  // namespace

std::vector<double> segment_curvatures(const std::vector<std::array<Vec3, 2>>& segments) {
  const std::vector<Index> points = point_numbers(segments);
  // End 2 s + i is end i of segment s.
  const auto away_from = [&](Index end) {
    return Vec3(segments[end / 2][1 - end % 2] - segments[end / 2][end % 2]);
  };
  std::vector<int> count(points.size(), 0);
  std::vector<std::array<Index, 2>> ends_at(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Index end = static_cast<Index>(i);
    const double length = away_from(end).norm();
    if (std::isfinite(length) && length > 0.0) {
      ends_at[points[i]][count[points[i]]++ % 2] = end;
    }
  }
  std::vector<double> curvatures(segments.size(), 0.0);
  for (std::size_t point = 0; point < points.size(); ++point) {
    if (count[point] == 2) {
      const auto [one, other] = ends_at[point];
      const double curvature = turn_curvature(-away_from(one), away_from(other));
      curvatures[one / 2] = std::max(curvatures[one / 2], curvature);
      curvatures[other / 2] = std::max(curvatures[other / 2], curvature);
    }
  }
  return curvatures;
}

std::vector<double> triangle_curvatures(const std::vector<std::array<Vec3, 3>>& triangles) {
  const FacetedSurface surface(triangles);
  std::vector<double> curvatures(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    curvatures[t] = surface.curvature(t);
  }
  return curvatures;
}

}  // namespace meshgrow
