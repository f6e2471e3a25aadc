#ifndef MESHGROW_PLANAR_TRIANGULATION_H
#define MESHGROW_PLANAR_TRIANGULATION_H

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace meshgrow {

/// Constrained Delaunay triangulation of points in the plane, to which points and segments are
/// added one at a time, in any order.
///
/// Points are rounded to a grid of 2^26 steps over the longer side of the box (the same step in
/// both directions), so that every predicate is exact in integers and no input, however degenerate,
/// leads astray: coincident points become one, a segment through a point is split there. Not
/// thread-safe, except that const functions may run beside each other.
class PlanarTriangulation {
 public:
  using Point = Eigen::Vector2d;

  /// For points within the box (points beyond it are moved onto its border). A box without extent
  /// in a direction is allowed. Throws Error if the box is empty or not finite.
  explicit PlanarTriangulation(const Eigen::AlignedBox2d& box);

  /// Index of the point, counted from 0 in the order of adding; the index of the earlier one where
  /// both fall on the same place of the grid (such a point takes no number: the next new point
  /// continues the count). A point that falls on a segment splits it; one that was computed on a
  /// slanted segment may well be rounded to either side of it. Throws Error if it is not finite.
  std::size_t add_point(const Point& point);

  /// Makes the segment between two points an edge, or a chain of edges through points on it. With
  /// `is_border`, it separates inside from outside (twice the same border counts as none: an edge
  /// with the inside on both sides). Returns false and changes nothing if it would cross an
  /// earlier segment elsewhere than in a point. `a` and `b` are indices from add_point; a == b is
  /// allowed and adds nothing.
  bool add_segment(std::size_t a, std::size_t b, bool is_border = true);

  /// Triangles inside the borders by the even-odd rule, counter-clockwise, as indices of points.
  /// Means something only where the borders form closed curves.
  std::vector<std::array<std::size_t, 3>> inner_triangles() const;

  /// Whether a and b are the ends of an edge that belongs to a segment.
  bool is_on_segment(std::size_t a, std::size_t b) const;

 private:
  struct GridPoint {
    std::int64_t x;
    std::int64_t y;
  };

  /// Counter-clockwise; neighbours[i] lies across side i, which is opposite vertices[i].
  struct Triangle {
    std::array<int, 3> vertices;
    std::array<int, 3> neighbours;
  };

  /// Side of a triangle; runs from vertices[side + 1] to vertices[side + 2], modulo 3.
  struct Edge {
    int triangle;
    int side;
  };

  struct Location {
    int triangle;
    int side;    ///< that the place is on, or none
    int vertex;  ///< that is at the place, or none
  };

  /// Way from a vertex to the first other vertex on a segment, and the edges crossed between them.
  struct Stretch {
    int end;
    std::vector<Edge> crossed;
  };

  /// Number of borders on an edge that belongs to a segment, by edge_key.
  using BorderCounts = std::unordered_map<std::uint64_t, int>;

  static constexpr int none = -1;
  /// The first vertices are the corners of a triangle around everything.
  static constexpr int far_vertices = 3;

  static std::uint64_t edge_key(int a, int b);
  static int vertex_of(std::size_t index) { return static_cast<int>(index) + far_vertices; }
  static std::size_t index_of_vertex(int v) { return static_cast<std::size_t>(v - far_vertices); }

  GridPoint to_grid(const Point& point) const;
  std::int64_t orientation(int a, int b, const GridPoint& p) const;
  std::int64_t orientation(int a, int b, int c) const { return orientation(a, b, places_[c]); }
  bool is_in_circle(const Triangle& triangle, int vertex) const;

  int corner_of(const Edge& edge, int turns) const {
    return triangles_[edge.triangle].vertices[(edge.side + turns) % 3];
  }
  int apex_of(const Edge& edge) const { return corner_of(edge, 0); }
  int start_of(const Edge& edge) const { return corner_of(edge, 1); }
  int end_of(const Edge& edge) const { return corner_of(edge, 2); }
  std::uint64_t key_of(const Edge& edge) const { return edge_key(start_of(edge), end_of(edge)); }
  bool is_segment(const Edge& edge) const { return border_counts_.count(key_of(edge)) > 0; }
  Edge across(const Edge& edge) const;

  Location locate(const GridPoint& p);
  int side_towards(const GridPoint& p, const Edge& entrance);
  Location location_in(int triangle, const GridPoint& p) const;

  void set_triangle(int triangle, const std::array<int, 3>& vertices,
                    const std::array<int, 3>& neighbours);
  void replace_neighbour(int triangle, int before, int after);
  std::array<int, 3> split_triangle(int triangle, int vertex);
  void split_segment(const Edge& edge, int vertex);
  void flip(const Edge& edge, std::vector<Edge>& suspects);
  void restore_delaunay(std::vector<Edge>& suspects);

  std::optional<std::vector<int>> way_through_vertices(int from, int to) const;
  Stretch first_stretch(int from, int to) const;
  Stretch first_crossing(int from, int to) const;
  void make_edge(int from, int to);
  void fill_pocket(const std::vector<int>& rim, std::vector<std::array<int, 3>>& corners) const;
  void replace_triangles(std::vector<int>& triangles,
                         const std::vector<std::array<int, 3>>& corners);
  void make_neighbours(const std::vector<Edge>& sides);

  std::vector<bool> is_inside() const;

  Eigen::AlignedBox2d box_;
  double step_ = 1.0;
  std::vector<GridPoint> places_;        ///< of the vertices
  std::vector<int> triangle_at_vertex_;  ///< any one
  std::vector<Triangle> triangles_;
  BorderCounts border_counts_;
  int last_triangle_ = 0;
  std::uint32_t random_state_ = 1;
};

}  // namespace meshgrow

#endif
