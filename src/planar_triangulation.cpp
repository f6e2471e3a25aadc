#include "planar_triangulation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "error.h"

namespace meshgrow {

namespace {

__extension__ typedef __int128 Int128;

constexpr std::int64_t grid_steps = std::int64_t{1} << 26;

constexpr int next(int corner) { return corner == 2 ? 0 : corner + 1; }
constexpr int previous(int corner) { return corner == 0 ? 2 : corner - 1; }

int position(const std::array<int, 3>& three, int value) {
  return three[0] == value ? 0 : three[1] == value ? 1 : 2;
}

void append_other(std::vector<int>& list, int item) {
  if (list.back() != item) {
    list.push_back(item);
  }
}

}  // namespace

PlanarTriangulation::PlanarTriangulation(const Eigen::AlignedBox2d& box)
    : box_(box),
      // Every point of the grid is strictly inside this triangle. No difference of coordinates
      // exceeds 5 * 2^26 < 2^28.4, so an orientation stays below 2^58 and an in-circle determinant
      // below 2^118. Inside closed borders, from where the far vertices cannot be seen, the result
      // is the same as without them.
      places_{
          {-grid_steps, -grid_steps}, {4 * grid_steps, -grid_steps}, {-grid_steps, 4 * grid_steps}},
      triangle_at_vertex_(far_vertices, 0),
      triangles_{{{0, 1, 2}, {none, none, none}}} {
  if (box.isEmpty() || !box.sizes().allFinite()) {
    throw Error("The box of a planar triangulation is empty or infinite; give it finite corners.");
  }
  step_ = box.sizes().maxCoeff() / static_cast<double>(grid_steps);
  if (step_ == 0.0) {
    step_ = 1.0;
  }
}

std::size_t PlanarTriangulation::add_point(const Point& point) {
  if (!point.allFinite()) {
    throw Error("A point of a planar triangulation is not finite; give it finite coordinates.");
  }
  const GridPoint place = to_grid(point);
  const Location location = locate(place);
  if (location.vertex != none) {
    return index_of_vertex(location.vertex);
  }
  const int vertex = static_cast<int>(places_.size());
  places_.push_back(place);
  triangle_at_vertex_.push_back(location.triangle);

  if (location.side != none) {
    split_segment({location.triangle, location.side}, vertex);
  }
  const std::array<int, 3> parts = split_triangle(location.triangle, vertex);
  std::vector<Edge> suspects;
  if (location.side != none) {
    // The vertex is on a side of this part, which has no area before the flip.
    flip({parts[location.side], 0}, suspects);
  }
  for (const int part : parts) {
    suspects.push_back({part, 0});
  }
  restore_delaunay(suspects);
  return index_of_vertex(vertex);
}

bool PlanarTriangulation::add_segment(std::size_t a, std::size_t b, bool is_border) {
  const std::optional<std::vector<int>> way = way_through_vertices(vertex_of(a), vertex_of(b));
  if (!way) {
    return false;
  }
  for (std::size_t i = 1; i < way->size(); ++i) {
    const int from = (*way)[i - 1];
    const int to = (*way)[i];
    make_edge(from, to);
    border_counts_[edge_key(from, to)] += is_border ? 1 : 0;
  }
  return true;
}

std::vector<std::array<std::size_t, 3>> PlanarTriangulation::inner_triangles() const {
  const std::vector<bool> inside = is_inside();
  std::vector<std::array<std::size_t, 3>> result;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [a, b, c] = triangles_[t].vertices;
    if (inside[t] && std::min({a, b, c}) >= far_vertices) {
      result.push_back({index_of_vertex(a), index_of_vertex(b), index_of_vertex(c)});
    }
  }
  return result;
}

bool PlanarTriangulation::is_on_segment(std::size_t a, std::size_t b) const {
  return border_counts_.count(edge_key(vertex_of(a), vertex_of(b))) > 0;
}

// ==== Predicates

PlanarTriangulation::GridPoint PlanarTriangulation::to_grid(const Point& point) const {
  const auto steps = [&](int axis) {
    const double within = std::clamp(point[axis], box_.min()[axis], box_.max()[axis]);
    const double distance = std::round((within - box_.min()[axis]) / step_);
    // A step that is not a normal number is too inexact to end within the grid.
    return static_cast<std::int64_t>(std::min(distance, static_cast<double>(grid_steps)));
  };
  return {steps(0), steps(1)};
}

/// Twice the area of the triangle a b p: positive if p is left of the way from a to b.
std::int64_t PlanarTriangulation::orientation(int a, int b, const GridPoint& p) const {
  const GridPoint& from = places_[a];
  const GridPoint& to = places_[b];
  return (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
}

bool PlanarTriangulation::is_in_circle(const Triangle& triangle, int vertex) const {
  const GridPoint& center = places_[vertex];
  std::array<GridPoint, 3> p;
  std::array<Int128, 3> square;
  for (int i = 0; i < 3; ++i) {
    const GridPoint& corner = places_[triangle.vertices[i]];
    p[i] = {corner.x - center.x, corner.y - center.y};
    square[i] = p[i].x * p[i].x + p[i].y * p[i].y;
  }
  const auto cross = [&p](int i, int j) { return p[i].x * p[j].y - p[i].y * p[j].x; };
  return square[0] * cross(1, 2) + square[1] * cross(2, 0) + square[2] * cross(0, 1) > 0;
}

// ==== Edges

std::uint64_t PlanarTriangulation::edge_key(int a, int b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 |
         static_cast<std::uint64_t>(std::max(a, b));
}

/// The same edge as a side of the neighbour, which must exist.
PlanarTriangulation::Edge PlanarTriangulation::across(const Edge& edge) const {
  const int neighbour = triangles_[edge.triangle].neighbours[edge.side];
  return {neighbour, position(triangles_[neighbour].neighbours, edge.triangle)};
}

// ==== Point location

/// Walks there from where the last walk ended.
PlanarTriangulation::Location PlanarTriangulation::locate(const GridPoint& p) {
  Edge entrance{last_triangle_, none};
  for (int side = side_towards(p, entrance); side != none; side = side_towards(p, entrance)) {
    entrance = across({entrance.triangle, side});
  }
  last_triangle_ = entrance.triangle;
  return location_in(last_triangle_, p);
}

/// A side of the entered triangle that has p beyond it, or none. The first side to look at is
/// random: otherwise a walk might go in circles, since segments keep the triangles from being
/// Delaunay.
int PlanarTriangulation::side_towards(const GridPoint& p, const Edge& entrance) {
  random_state_ = random_state_ * 1664525U + 1013904223U;
  int side = static_cast<int>((random_state_ >> 16) % 3);
  for (int i = 0; i < 3; ++i, side = next(side)) {
    const Edge edge{entrance.triangle, side};
    if (side != entrance.side && orientation(start_of(edge), end_of(edge), p) < 0) {
      return side;
    }
  }
  return none;
}

PlanarTriangulation::Location PlanarTriangulation::location_in(int triangle,
                                                               const GridPoint& p) const {
  Location location{triangle, none, none};
  for (int side = 0; side < 3; ++side) {
    const Edge edge{triangle, side};
    if (orientation(start_of(edge), end_of(edge), p) == 0) {
      location.side = side;
    }
    const GridPoint& corner = places_[apex_of(edge)];
    if (corner.x == p.x && corner.y == p.y) {
      location.vertex = apex_of(edge);
    }
  }
  return location;
}

// ==== Changes

void PlanarTriangulation::set_triangle(int triangle, const std::array<int, 3>& vertices,
                                       const std::array<int, 3>& neighbours) {
  triangles_[triangle] = {vertices, neighbours};
  for (const int vertex : vertices) {
    triangle_at_vertex_[vertex] = triangle;
  }
}

void PlanarTriangulation::replace_neighbour(int triangle, int before, int after) {
  if (triangle != none) {
    std::array<int, 3>& neighbours = triangles_[triangle].neighbours;
    neighbours[position(neighbours, before)] = after;
  }
}

/// Part i, on side i of the triangle, has the vertex as vertex 0.
std::array<int, 3> PlanarTriangulation::split_triangle(int triangle, int vertex) {
  const auto [a, b, c] = triangles_[triangle].vertices;
  const auto [beyond_a, beyond_b, beyond_c] = triangles_[triangle].neighbours;
  const int second = static_cast<int>(triangles_.size());
  const int third = second + 1;
  triangles_.resize(triangles_.size() + 2);
  set_triangle(triangle, {vertex, b, c}, {beyond_a, second, third});
  set_triangle(second, {vertex, c, a}, {beyond_b, third, triangle});
  set_triangle(third, {vertex, a, b}, {beyond_c, triangle, second});
  replace_neighbour(beyond_b, triangle, second);
  replace_neighbour(beyond_c, triangle, third);
  return {triangle, second, third};
}

/// Nothing if the edge belongs to no segment.
void PlanarTriangulation::split_segment(const Edge& edge, int vertex) {
  const auto found = border_counts_.find(key_of(edge));
  if (found != border_counts_.end()) {
    const int count = found->second;
    border_counts_.erase(found);
    border_counts_[edge_key(start_of(edge), vertex)] = count;
    border_counts_[edge_key(vertex, end_of(edge))] = count;
  }
}

/// Replaces the edge by the other diagonal of the two triangles beside it. Afterwards, their edges
/// may not be Delaunay and join the suspects.
void PlanarTriangulation::flip(const Edge& edge, std::vector<Edge>& suspects) {
  const Edge other = across(edge);
  const int start = start_of(edge);
  const int end = end_of(edge);
  const int apex = apex_of(edge);
  const int other_apex = apex_of(other);
  const std::array<int, 3> neighbours = triangles_[edge.triangle].neighbours;
  const std::array<int, 3> other_neighbours = triangles_[other.triangle].neighbours;
  const int beyond_apex_end = neighbours[next(edge.side)];
  const int beyond_apex_start = neighbours[previous(edge.side)];
  const int beyond_other_start = other_neighbours[next(other.side)];
  const int beyond_other_end = other_neighbours[previous(other.side)];

  set_triangle(edge.triangle, {apex, start, other_apex},
               {beyond_other_start, other.triangle, beyond_apex_start});
  set_triangle(other.triangle, {apex, other_apex, end},
               {beyond_other_end, beyond_apex_end, edge.triangle});
  replace_neighbour(beyond_other_start, other.triangle, edge.triangle);
  replace_neighbour(beyond_apex_end, edge.triangle, other.triangle);
  for (int side = 0; side < 3; ++side) {
    suspects.push_back({edge.triangle, side});
    suspects.push_back({other.triangle, side});
  }
}

/// Lawson's flips. A suspect that a flip has moved is among the suspects of that flip again.
void PlanarTriangulation::restore_delaunay(std::vector<Edge>& suspects) {
  while (!suspects.empty()) {
    const Edge edge = suspects.back();
    suspects.pop_back();
    const Triangle& triangle = triangles_[edge.triangle];
    if (triangle.neighbours[edge.side] != none && is_in_circle(triangle, apex_of(across(edge))) &&
        !is_segment(edge)) {
      flip(edge, suspects);
    }
  }
}

// ==== Segments

/// The vertices on the segment, in order and with its ends; nothing if it crosses another.
std::optional<std::vector<int>> PlanarTriangulation::way_through_vertices(int from, int to) const {
  std::vector<int> way = {from};
  while (way.back() != to) {
    const Stretch stretch = first_stretch(way.back(), to);
    if (std::any_of(stretch.crossed.begin(), stretch.crossed.end(),
                    [this](const Edge& edge) { return is_segment(edge); })) {
      return std::nullopt;
    }
    way.push_back(stretch.end);
  }
  return way;
}

PlanarTriangulation::Stretch PlanarTriangulation::first_stretch(int from, int to) const {
  Stretch stretch = first_crossing(from, to);
  while (stretch.end == none) {
    // The crossed edges run from right to left of the way.
    const Edge entrance = across(stretch.crossed.back());
    const std::int64_t turn = orientation(from, to, apex_of(entrance));
    if (turn == 0) {
      stretch.end = apex_of(entrance);
    } else {
      const int side = turn > 0 ? next(entrance.side) : previous(entrance.side);
      stretch.crossed.push_back({entrance.triangle, side});
    }
  }
  return stretch;
}

/// Either a vertex next to `from` or the first crossed edge. Ends because `from` is no far vertex
/// and thus has triangles all around.
PlanarTriangulation::Stretch PlanarTriangulation::first_crossing(int from, int to) const {
  Edge edge{triangle_at_vertex_[from], none};
  while (true) {
    edge.side = position(triangles_[edge.triangle].vertices, from);
    const std::int64_t turn = orientation(from, to, start_of(edge));
    if (turn <= 0 && orientation(from, to, end_of(edge)) > 0) {
      return turn == 0 ? Stretch{start_of(edge), {}} : Stretch{none, {edge}};
    }
    edge.triangle = triangles_[edge.triangle].neighbours[next(edge.side)];
  }
}

/// Triangulates the pockets on both sides of the edge anew. None of the crossed edges may belong to
/// a segment.
void PlanarTriangulation::make_edge(int from, int to) {
  border_counts_.insert({edge_key(from, to), 0});
  const std::vector<Edge> crossed = first_stretch(from, to).crossed;
  if (crossed.empty()) {
    return;
  }
  std::vector<int> left = {from};
  std::vector<int> right = {to};
  std::vector<int> crossed_triangles = {across(crossed.back()).triangle};
  for (std::size_t i = 0; i < crossed.size(); ++i) {
    crossed_triangles.push_back(crossed[i].triangle);
    append_other(left, end_of(crossed[i]));
    append_other(right, start_of(crossed[crossed.size() - 1 - i]));
  }
  left.push_back(to);
  right.push_back(from);
  std::vector<std::array<int, 3>> corners;
  fill_pocket(left, corners);
  fill_pocket(right, corners);
  replace_triangles(crossed_triangles, corners);
}

/// Cuts off the convex corners of the rim of a pocket, which has its inside on the right and all
/// vertices in sight of the edge between its ends. In such a polygon, the triangle at a convex
/// corner is always free (Toussaint and Avis, On a convex hull algorithm for polygons and its
/// application to triangulation problems, 1982).
void PlanarTriangulation::fill_pocket(const std::vector<int>& rim,
                                      std::vector<std::array<int, 3>>& corners) const {
  std::vector<int> rest;
  for (const int vertex : rim) {
    while (rest.size() > 1 && orientation(rest[rest.size() - 2], rest.back(), vertex) < 0) {
      corners.push_back({rest[rest.size() - 2], vertex, rest.back()});
      rest.pop_back();
    }
    rest.push_back(vertex);
  }
}

/// By as many others that cover the same region, and makes these Delaunay.
void PlanarTriangulation::replace_triangles(std::vector<int>& triangles,
                                            const std::vector<std::array<int, 3>>& corners) {
  std::sort(triangles.begin(), triangles.end());
  std::vector<Edge> sides;
  for (const int triangle : triangles) {
    for (int side = 0; side < 3; ++side) {
      const int neighbour = triangles_[triangle].neighbours[side];
      if (neighbour != none && !std::binary_search(triangles.begin(), triangles.end(), neighbour)) {
        sides.push_back(across({triangle, side}));
      }
    }
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    set_triangle(triangles[i], corners[i], {none, none, none});
    for (int side = 0; side < 3; ++side) {
      sides.push_back({triangles[i], side});
    }
  }
  make_neighbours(sides);
  restore_delaunay(sides);
}

/// Joins sides with the same ends. By their ends, since an edge may reach into a pocket from its
/// rim, with both of its sides in it.
void PlanarTriangulation::make_neighbours(const std::vector<Edge>& sides) {
  std::vector<std::pair<std::uint64_t, Edge>> by_ends;
  by_ends.reserve(sides.size());
  for (const Edge& side : sides) {
    by_ends.emplace_back(key_of(side), side);
  }
  std::sort(by_ends.begin(), by_ends.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 1; i < by_ends.size(); ++i) {
    if (by_ends[i - 1].first == by_ends[i].first) {
      const Edge& edge = by_ends[i - 1].second;
      const Edge& other = by_ends[i].second;
      triangles_[edge.triangle].neighbours[edge.side] = other.triangle;
      triangles_[other.triangle].neighbours[other.side] = edge.triangle;
    }
  }
}

// ==== Inside and outside

/// Flood fill from a far vertex.
std::vector<bool> PlanarTriangulation::is_inside() const {
  std::vector<bool> inside(triangles_.size(), false);
  std::vector<bool> reached(triangles_.size(), false);
  std::vector<int> front = {triangle_at_vertex_[0]};
  reached[front.back()] = true;
  while (!front.empty()) {
    const int triangle = front.back();
    front.pop_back();
    for (int side = 0; side < 3; ++side) {
      const Edge edge{triangle, side};
      const int neighbour = triangles_[triangle].neighbours[side];
      if (neighbour != none && !reached[neighbour]) {
        const auto borders = border_counts_.find(key_of(edge));
        const bool changes = borders != border_counts_.end() && borders->second % 2 != 0;
        inside[neighbour] = inside[triangle] != changes;
        reached[neighbour] = true;
        front.push_back(neighbour);
      }
    }
  }
  return inside;
}

}  // namespace meshgrow
