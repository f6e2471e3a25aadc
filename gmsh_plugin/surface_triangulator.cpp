#include "surface_triangulator.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "error.h"

namespace meshgrow {

namespace {

constexpr double least_turn = 1e-3;  // degrees
constexpr int lines_at_first = 6;
constexpr int most_rounds = 40;
constexpr std::size_t most_points = 400000;
/// Sides shorter than this part of the surface are not cut.
constexpr double smallest_side = 1e-3;
/// Ends of curves at one point of the model are one vertex if so near, in parts of the range.
constexpr double end_tolerance = 0.01;

}  // namespace

SurfaceTriangulator::SurfaceTriangulator(const Entity& surface,
                                         const std::vector<CurveOnSurface>& curves, double max_turn)
    : surface_(surface), max_turn_(max_turn) {
  measure_range(curves);
  measure_stretch();
  triangulation_ = std::make_unique<PlanarTriangulation>(Eigen::AlignedBox2d(
      Point(Point::Zero()), stretched(low_[0] + range_[0], low_[1] + range_[1])));
  for (const CurveOnSurface& curve : curves) {
    add_curve(curve);
  }
  if (!is_closed()) {
    throw Error(entity_name(surface) + " has a gap in its border: mesh it first.");
  }
}

void SurfaceTriangulator::measure_range(const std::vector<CurveOnSurface>& curves) {
  // Not Gmsh's parameter bounds: 4.8 has wrong ones for planes.
  Eigen::AlignedBox2d box;
  for (const CurveOnSurface& curve : curves) {
    for (std::size_t i = 0; i + 1 < curve.uv.size(); i += 2) {
      box.extend(Point(curve.uv[i], curve.uv[i + 1]));
    }
  }
  for (int i = 0; i < 2; ++i) {
    low_[i] = box.min()[i];
    range_[i] = box.max()[i] - box.min()[i];
    if (!(range_[i] > 0.0) || !std::isfinite(range_[i])) {
      throw Error(entity_name(surface_) + " has no usable parametrisation: mesh it first.");
    }
  }
}

void SurfaceTriangulator::measure_stretch() {
  constexpr int n = 7;
  std::vector<double> uv;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      uv.push_back(low_[0] + range_[0] * i / (n - 1));
      uv.push_back(low_[1] + range_[1] * j / (n - 1));
    }
  }
  const std::vector<Vec3> points = gmsh::points_at(surface_, uv);
  const std::vector<Vec3> normals = gmsh::normals_at(surface_, uv);
  Point turn = Point::Zero();
  Point length = Point::Zero();
  for (int line = 0; line < n; ++line) {
    Point line_turn = Point::Zero();
    Point line_length = Point::Zero();
    for (int i = 0; i + 1 < n; ++i) {
      const int along_u[] = {i * n + line, (i + 1) * n + line};
      const int along_v[] = {line * n + i, line * n + i + 1};
      line_turn += Point(turn_between(normals[along_u[0]], normals[along_u[1]]),
                         turn_between(normals[along_v[0]], normals[along_v[1]]));
      line_length += Point((points[along_u[1]] - points[along_u[0]]).norm(),
                           (points[along_v[1]] - points[along_v[0]]).norm());
    }
    turn = turn.cwiseMax(line_turn);
    length = length.cwiseMax(line_length);
  }
  if (!(length.maxCoeff() > 0.0) || !length.allFinite()) {
    throw Error(entity_name(surface_) + " has no extent: mesh it first.");
  }
  smallest_side_ = smallest_side * length.maxCoeff();
  is_flat_ = turn.maxCoeff() < least_turn;
  turns_both_ways_ = turn.minCoeff() >= least_turn;
  stretch_ = turn / max_turn_ + length / length.maxCoeff();
}

SurfaceTriangulator::Point SurfaceTriangulator::stretched(double u, double v) const {
  return Point((u - low_[0]) / range_[0] * stretch_[0], (v - low_[1]) / range_[1] * stretch_[1]);
}

std::size_t SurfaceTriangulator::add_vertex(double u, double v, const Vec3& point,
                                            const Vec3& normal) {
  const std::size_t index = triangulation_->add_point(stretched(u, v));
  if (index == normals_.size()) {
    sampled_.parameters.push_back({u, v});
    sampled_.points.push_back(point);
    normals_.push_back(normal);
    border_degree_.push_back(0);
  }
  return index;
}

std::size_t SurfaceTriangulator::end_vertex(double u, double v, const Vec3& point,
                                            const Vec3& normal) {
  for (const std::size_t end : ends_) {
    const auto& [end_u, end_v] = sampled_.parameters[end];
    if (sampled_.points[end] == point && std::abs(end_u - u) < end_tolerance * range_[0] &&
        std::abs(end_v - v) < end_tolerance * range_[1]) {
      return end;
    }
  }
  ends_.push_back(add_vertex(u, v, point, normal));
  return ends_.back();
}

std::vector<std::size_t> SurfaceTriangulator::vertices_of(const CurveOnSurface& curve) {
  const std::vector<Vec3> normals = normals_along(surface_, curve.uv, curve.points);
  std::vector<std::size_t> vertices;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const bool is_end = i == 0 || i + 1 == curve.points.size();
    vertices.push_back(
        (this->*(is_end ? &SurfaceTriangulator::end_vertex : &SurfaceTriangulator::add_vertex))(
            curve.uv[2 * i], curve.uv[2 * i + 1], curve.points[i], normals[i]));
  }
  return vertices;
}

void SurfaceTriangulator::add_curve(const CurveOnSurface& curve) {
  if (curve.uv.size() != 2 * curve.points.size()) {
    throw Error(entity_name(surface_) + " does not know the curves on its border: mesh it first.");
  }
  const std::vector<std::size_t> vertices = vertices_of(curve);
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
    if (vertices[i] == vertices[i + 1]) {
      continue;
    }
    // An embedded curve that crosses another one is no reason to give the surface up.
    if (!triangulation_->add_segment(vertices[i], vertices[i + 1], curve.is_border) &&
        curve.is_border) {
      throw Error(entity_name(surface_) + " has a border that crosses itself: mesh it first.");
    }
    if (curve.is_border) {
      ++border_degree_[vertices[i]];
      ++border_degree_[vertices[i + 1]];
    }
  }
}

bool SurfaceTriangulator::is_closed() const {
  return std::all_of(border_degree_.begin(), border_degree_.end(),
                     [](int degree) { return degree % 2 == 0; });
}

void SurfaceTriangulator::add_inner_points(const std::vector<double>& uv) {
  const std::vector<Vec3> points = gmsh::points_at(surface_, uv);
  const std::vector<Vec3> normals = gmsh::normals_at(surface_, uv);
  for (std::size_t i = 0; i < points.size(); ++i) {
    add_vertex(uv[2 * i], uv[2 * i + 1], points[i], normals[i]);
  }
}

bool SurfaceTriangulator::is_tilted(const std::array<std::size_t, 3>& triangle) const {
  // A long and narrow facet across a bend may lie askew though the normals at its corners agree.
  const auto& [a, b, c] = triangle;
  const std::vector<Vec3>& points = sampled_.points;
  const double turn = turn_between((points[b] - points[a]).cross(points[c] - points[a]),
                                   normals_[a] + normals_[b] + normals_[c]);
  return std::min(turn, 180.0 - turn) > max_turn_;
}

std::vector<double> SurfaceTriangulator::points_wanted() const {
  std::set<Side> sides;
  for (const auto& triangle : triangulation_->inner_triangles()) {
    Side most_turned = {0, 0};
    Side longest = {0, 0};
    double most_turn = max_turn_;
    double length = smallest_side_;
    for (int i = 0; i < 3; ++i) {
      const std::size_t a = std::min(triangle[i], triangle[(i + 1) % 3]);
      const std::size_t b = std::max(triangle[i], triangle[(i + 1) % 3]);
      const double side = (sampled_.points[a] - sampled_.points[b]).norm();
      if (side > length) {
        length = side;
        longest = {a, b};
      }
      const double turn = turn_between(normals_[a], normals_[b]);
      if (turn > most_turn && side > smallest_side_ && !triangulation_->is_on_segment(a, b)) {
        most_turn = turn;
        most_turned = {a, b};
      }
    }
    if (most_turned[0] != most_turned[1]) {
      sides.insert(most_turned);
    } else if (longest[0] != longest[1] && is_tilted(triangle) &&
               !triangulation_->is_on_segment(longest[0], longest[1])) {
      sides.insert(longest);
    }
  }
  std::vector<double> uv;
  for (const Side& side : sides) {
    for (int i = 0; i < 2; ++i) {
      uv.push_back(0.5 * (sampled_.parameters[side[0]][i] + sampled_.parameters[side[1]][i]));
    }
  }
  return uv;
}

void SurfaceTriangulator::refine() {
  if (is_flat_) {
    return;
  }
  if (turns_both_ways_) {
    // A bump inside need not show on the borders. (Where only one direction turns, it does.)
    std::vector<double> lattice;
    for (int i = 1; i < lines_at_first; ++i) {
      for (int j = 1; j < lines_at_first; ++j) {
        lattice.push_back(low_[0] + range_[0] * i / lines_at_first);
        lattice.push_back(low_[1] + range_[1] * j / lines_at_first);
      }
    }
    add_inner_points(lattice);
  }
  for (int round = 0; round < most_rounds && normals_.size() < most_points; ++round) {
    const std::size_t before = normals_.size();
    const std::vector<double> wanted = points_wanted();
    if (!wanted.empty()) {
      add_inner_points(wanted);
    }
    if (normals_.size() == before) {
      return;
    }
  }
}

SampledSurface SurfaceTriangulator::result() const {
  SampledSurface result = sampled_;
  for (const auto& triangle : triangulation_->inner_triangles()) {
    const Vec3& a = result.points[triangle[0]];
    const Vec3& b = result.points[triangle[1]];
    const Vec3& c = result.points[triangle[2]];
    if (a != b && b != c && c != a) {
      result.triangles.push_back(triangle);
    }
  }
  return result;
}

}  // namespace meshgrow
