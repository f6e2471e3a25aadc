#include "planar_triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "error.h"
#include "random_facets.h"

namespace meshgrow {
namespace {

using test::Random;
using test::random_index;
using test::uniform;
using Point = PlanarTriangulation::Point;
using PlaneBox = Eigen::AlignedBox2d;
using Triple = std::array<std::size_t, 3>;
using Pair = std::pair<std::size_t, std::size_t>;

__extension__ typedef __int128 Int128;

constexpr double pi = 3.14159265358979323846;

struct Place {
  std::int64_t x;
  std::int64_t y;
  bool operator==(const Place& other) const { return x == other.x && y == other.y; }
  bool operator<(const Place& other) const { return std::pair(x, y) < std::pair(other.x, other.y); }
};

std::int64_t orientation(const Place& a, const Place& b, const Place& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

int sign(std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

bool in_circle(const Place& a, const Place& b, const Place& c, const Place& d) {
  const auto term = [&d](const Place& p, const Place& q, const Place& r) {
    const Int128 square = (p.x - d.x) * (p.x - d.x) + (p.y - d.y) * (p.y - d.y);
    return square * orientation(d, q, r);
  };
  return term(a, b, c) + term(b, c, a) + term(c, a, b) > 0;
}

/// Whether p is on the segment a b, ends included.
bool is_on(const Place& a, const Place& b, const Place& p) {
  return orientation(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) &&
         std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y);
}

bool cross_properly(const Place& a, const Place& b, const Place& c, const Place& d) {
  return sign(orientation(a, b, c)) * sign(orientation(a, b, d)) < 0 &&
         sign(orientation(c, d, a)) * sign(orientation(c, d, b)) < 0;
}

bool touch(const Place& a, const Place& b, const Place& c, const Place& d) {
  return cross_properly(a, b, c, d) || is_on(a, b, c) || is_on(a, b, d) || is_on(c, d, a) ||
         is_on(c, d, b);
}

PlaneBox box(double x0, double y0, double x1, double y1) {
  return PlaneBox(Point(x0, y0), Point(x1, y1));
}

const PlaneBox unit_square = box(0, 0, 1, 1);

/// A triangulation and, beside it, the same points and edges of segments by brute force.
class Checked {
 public:
  explicit Checked(const PlaneBox& box) : box_(box), triangulation_(box) {}

  std::size_t add(double x, double y) {
    const Place place = rounded(Point(x, y));
    const std::size_t index = triangulation_.add_point(Point(x, y));
    const auto known = std::find(places_.begin(), places_.end(), place);
    EXPECT_EQ(index, static_cast<std::size_t>(known - places_.begin()));
    if (known == places_.end()) {
      places_.push_back(place);
      split_edges_at(index);
    }
    return index;
  }

  bool connect(std::size_t a, std::size_t b, bool is_border = true) {
    const std::vector<std::size_t> way = points_on(a, b);
    bool free = true;
    for (std::size_t i = 1; i < way.size(); ++i) {
      for (const auto& [edge, count] : edges_) {
        free = free && !cross_properly(places_[way[i - 1]], places_[way[i]], places_[edge.first],
                                       places_[edge.second]);
      }
    }
    const bool accepted = triangulation_.add_segment(a, b, is_border);
    EXPECT_EQ(accepted, free) << "segment from " << a << " to " << b;
    for (std::size_t i = 1; free && i < way.size(); ++i) {
      edges_[std::minmax(way[i - 1], way[i])] += is_border ? 1 : 0;
    }
    return accepted;
  }

  std::vector<std::size_t> add_polygon(const std::vector<Point>& corners, bool is_border = true) {
    std::vector<std::size_t> indices;
    indices.reserve(corners.size());
    for (const Point& corner : corners) {
      indices.push_back(add(corner.x(), corner.y()));
    }
    for (std::size_t i = 0; i < indices.size(); ++i) {
      EXPECT_TRUE(connect(indices[i], indices[(i + 1) % indices.size()], is_border));
    }
    return indices;
  }

  std::vector<std::size_t> add_rectangle(const PlaneBox& box) {
    return add_polygon({box.min(), Point(box.max().x(), box.min().y()), box.max(),
                        Point(box.min().x(), box.max().y())});
  }

  /// Twice the area in steps of the grid.
  std::int64_t doubled_area(const std::vector<std::size_t>& polygon) const {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Place& p = places_[polygon[i]];
      const Place& q = places_[polygon[(i + 1) % polygon.size()]];
      sum += p.x * q.y - p.y * q.x;
    }
    return std::abs(sum);
  }

  std::int64_t doubled_inner_area() const {
    std::int64_t sum = 0;
    for (const Triple& t : triangulation_.inner_triangles()) {
      sum += orientation(places_[t[0]], places_[t[1]], places_[t[2]]);
    }
    return sum;
  }

  /// Everything but the constrained Delaunay property of the interior.
  void expect_sound() const {
    std::map<Pair, std::size_t> apexes;
    const std::vector<Triple> triangles = triangulation_.inner_triangles();
    for (const Triple& t : triangles) {
      ASSERT_GT(orientation(places_[t[0]], places_[t[1]], places_[t[2]]), 0);
      for (int i = 0; i < 3; ++i) {
        const Pair edge(t[(i + 1) % 3], t[(i + 2) % 3]);
        ASSERT_TRUE(apexes.insert({edge, t[i]}).second) << "an edge has two triangles on one side";
      }
    }
    for (const auto& [edge, apex] : apexes) {
      const auto segment = edges_.find(std::minmax(edge.first, edge.second));
      const auto other = apexes.find({edge.second, edge.first});
      const bool is_border = segment != edges_.end() && segment->second % 2 == 1;
      ASSERT_EQ(triangulation_.is_on_segment(edge.first, edge.second), segment != edges_.end());
      ASSERT_EQ(other == apexes.end(), is_border);
      if (segment == edges_.end()) {
        // Together with the check of every other edge, this is the constrained Delaunay property.
        ASSERT_FALSE(in_circle(places_[edge.first], places_[edge.second], places_[apex],
                               places_[other->second]));
      }
    }
    for (const auto& [edge, count] : edges_) {
      ASSERT_TRUE(triangulation_.is_on_segment(edge.first, edge.second));
      ASSERT_TRUE(triangulation_.is_on_segment(edge.second, edge.first));
    }
  }

  /// No point in a triangle's circumcircle is visible from places inside the triangle.
  void expect_empty_circles() const {
    for (const Triple& t : triangulation_.inner_triangles()) {
      for (std::size_t p = 0; p < places_.size(); ++p) {
        if (in_circle(places_[t[0]], places_[t[1]], places_[t[2]], places_[p])) {
          ASSERT_FALSE(is_visible(t, p)) << p << " from " << t[0] << " " << t[1] << " " << t[2];
        }
      }
    }
  }

  void expect_right() const {
    expect_sound();
    expect_empty_circles();
  }

  const PlanarTriangulation& triangulation() const { return triangulation_; }
  std::size_t triangle_count() const { return triangulation_.inner_triangles().size(); }
  std::size_t point_count() const { return places_.size(); }
  std::size_t border_edge_count() const { return edges_.size(); }

 private:
  Place rounded(const Point& point) const {
    const Point within = point.cwiseMax(box_.min()).cwiseMin(box_.max());
    const double extent = box_.sizes().maxCoeff();
    const double step = extent > 0.0 ? extent / (1 << 26) : 1.0;
    const Point steps = (within - box_.min()) / step;
    return {std::llround(steps.x()), std::llround(steps.y())};
  }

  std::vector<std::size_t> points_on(std::size_t a, std::size_t b) const {
    std::vector<std::size_t> result;
    for (std::size_t p = 0; p < places_.size(); ++p) {
      if (is_on(places_[a], places_[b], places_[p])) {
        result.push_back(p);
      }
    }
    std::sort(result.begin(), result.end(),
              [this](std::size_t p, std::size_t q) { return places_[p] < places_[q]; });
    return result;
  }

  void split_edges_at(std::size_t point) {
    const std::map<Pair, int> before = edges_;
    for (const auto& [edge, count] : before) {
      if (is_on(places_[edge.first], places_[edge.second], places_[point])) {
        edges_.erase(edge);
        edges_[std::minmax(edge.first, point)] = count;
        edges_[std::minmax(point, edge.second)] = count;
      }
    }
  }

  /// From a few places in the triangle. A line of sight that grazes the end of a segment counts as
  /// blocked: that end is then in the circle, too, and visible itself unless something else is.
  bool is_visible(const Triple& triangle, std::size_t point) const {
    constexpr std::array<std::array<int, 3>, 4> weights = {
        {{3, 3, 3}, {7, 1, 1}, {1, 7, 1}, {1, 1, 7}}};
    constexpr int sum = 9;
    const auto enlarged = [](const Place& p) { return Place{sum * p.x, sum * p.y}; };
    const Place target = enlarged(places_[point]);
    return std::any_of(weights.begin(), weights.end(), [&](const std::array<int, 3>& weight) {
      Place eye{0, 0};
      for (int i = 0; i < 3; ++i) {
        eye.x += weight[i] * places_[triangle[i]].x;
        eye.y += weight[i] * places_[triangle[i]].y;
      }
      return std::none_of(edges_.begin(), edges_.end(), [&](const auto& item) {
        const auto& [a, b] = item.first;
        return a != point && b != point &&
               touch(eye, target, enlarged(places_[a]), enlarged(places_[b]));
      });
    });
  }

  PlaneBox box_;
  PlanarTriangulation triangulation_;
  std::vector<Place> places_;
  std::map<Pair, int> edges_;  ///< of segments, with the number of borders on each
};

std::string seed_text(unsigned seed) { return "seed " + std::to_string(seed); }

std::vector<Point> rectangle(double x0, double y0, double x1, double y1) {
  return {Point(x0, y0), Point(x1, y0), Point(x1, y1), Point(x0, y1)};
}

std::vector<Point> star(Random& random, const Point& center, double radius, int count) {
  std::vector<Point> corners;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * pi * (i + uniform(random, 0.0, 0.9)) / count;
    corners.push_back(center +
                      uniform(random, 0.1, 1.0) * radius * Point(std::cos(angle), std::sin(angle)));
  }
  return corners;
}

void add_random_points(Checked& checked, Random& random, const PlaneBox& box, int count) {
  for (int i = 0; i < count; ++i) {
    checked.add(uniform(random, box.min().x(), box.max().x()),
                uniform(random, box.min().y(), box.max().y()));
  }
}

// ==== Points alone

TEST(PlanarTriangulation, WithoutBordersHasNoInside) {
  PlanarTriangulation triangulation(unit_square);
  EXPECT_TRUE(triangulation.inner_triangles().empty());
  for (int i = 0; i < 5; ++i) {
    triangulation.add_point(Point(0.2 * i, 0.04 * i * i));
  }
  EXPECT_TRUE(triangulation.inner_triangles().empty());
  EXPECT_TRUE(triangulation.add_segment(0, 4, false));
  EXPECT_TRUE(triangulation.inner_triangles().empty());
}

TEST(PlanarTriangulation, OfRandomPointsIsDelaunay) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed_text(seed));
    Random random(seed);
    Checked checked(unit_square);
    const std::vector<std::size_t> square = checked.add_rectangle(unit_square);
    add_random_points(checked, random, unit_square, 150);
    checked.expect_right();
    EXPECT_EQ(checked.doubled_inner_area(), checked.doubled_area(square));
    EXPECT_EQ(checked.triangle_count(), 2 * checked.point_count() - 2 - 4);
  }
}

TEST(PlanarTriangulation, OfRegularGridTakesAnyDiagonals) {
  Checked checked(unit_square);
  for (int i = 0; i <= 16; ++i) {
    for (int j = 0; j <= 16; ++j) {
      checked.add(i / 16.0, j / 16.0);
    }
  }
  checked.add_rectangle(unit_square);
  checked.expect_right();
  EXPECT_EQ(checked.triangle_count(), 2u * 16 * 16);
  EXPECT_EQ(checked.border_edge_count(), 4u * 16);
}

TEST(PlanarTriangulation, OfCocircularPointsIsDelaunay) {
  Checked checked(box(-1, -1, 1, 1));
  std::vector<Point> corners;
  corners.reserve(100);
  for (int i = 0; i < 100; ++i) {
    corners.emplace_back(std::cos(2.0 * pi * i / 100), std::sin(2.0 * pi * i / 100));
  }
  const std::vector<std::size_t> circle = checked.add_polygon(corners);
  checked.expect_right();
  EXPECT_EQ(checked.triangle_count(), 98u);
  checked.add(0, 0);
  checked.expect_right();
  EXPECT_EQ(checked.doubled_inner_area(), checked.doubled_area(circle));
}

TEST(PlanarTriangulation, TakesCollinearPoints) {
  Checked checked(unit_square);
  for (const int i : {0, 16, 4, 12, 7, 8, 1, 15}) {
    checked.add(i / 16.0, i / 16.0);
  }
  EXPECT_TRUE(checked.connect(0, 1, false));
  EXPECT_EQ(checked.border_edge_count(), 7u);
  checked.add_rectangle(unit_square);
  checked.expect_right();
  EXPECT_EQ(checked.triangle_count(), 14u);
}

TEST(PlanarTriangulation, MakesCoincidentPointsOne) {
  PlanarTriangulation triangulation(unit_square);
  EXPECT_EQ(triangulation.add_point(Point(0.25, 0.5)), 0u);
  EXPECT_EQ(triangulation.add_point(Point(0.25 + 1e-9, 0.5)), 0u);
  EXPECT_EQ(triangulation.add_point(Point(0.75, 0.5)), 1u);
  EXPECT_EQ(triangulation.add_point(Point(0.25, 0.5 - 1e-9)), 0u);
  EXPECT_TRUE(triangulation.add_segment(0, 0));
  EXPECT_FALSE(triangulation.is_on_segment(0, 0));
}

TEST(PlanarTriangulation, MovesPointsBeyondTheBoxOntoItsBorder) {
  PlanarTriangulation triangulation(unit_square);
  EXPECT_EQ(triangulation.add_point(Point(1.0, 0.0)), 0u);
  EXPECT_EQ(triangulation.add_point(Point(1e300, -7.0)), 0u);
  EXPECT_EQ(triangulation.add_point(Point(0.5, 2.0)), 1u);
  EXPECT_EQ(triangulation.add_point(Point(0.5, 1.0)), 1u);
}

TEST(PlanarTriangulation, RefusesWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(PlanarTriangulation(PlaneBox{}), Error);
  EXPECT_THROW(PlanarTriangulation(box(0, 0, 1, infinity)), Error);
  EXPECT_THROW(PlanarTriangulation(box(0, 0, 1, nan)), Error);
  PlanarTriangulation triangulation(unit_square);
  EXPECT_THROW(triangulation.add_point(Point(nan, 0)), Error);
  EXPECT_THROW(triangulation.add_point(Point(0, infinity)), Error);
}

// ==== Boxes

TEST(PlanarTriangulation, TakesBoxWithoutExtent) {
  PlanarTriangulation at_point(box(3, 4, 3, 4));
  EXPECT_EQ(at_point.add_point(Point(3, 4)), 0u);
  EXPECT_EQ(at_point.add_point(Point(5, 5)), 0u);
  EXPECT_TRUE(at_point.inner_triangles().empty());

  Checked on_line(box(3, 4, 3, 6));
  for (const double y : {4.0, 5.0, 6.0, 5.5}) {
    on_line.add(3, y);
  }
  EXPECT_TRUE(on_line.connect(0, 2));
  EXPECT_TRUE(on_line.connect(2, 0));
  EXPECT_EQ(on_line.border_edge_count(), 3u);
  EXPECT_EQ(on_line.triangle_count(), 0u);
}

TEST(PlanarTriangulation, TakesTinyBox) {
  const double tiny = std::numeric_limits<double>::denorm_min();
  PlanarTriangulation triangulation(box(0, 0, 9 * tiny, 1000 * tiny));
  triangulation.add_point(Point(0, 0));
  triangulation.add_point(Point(9 * tiny, 1000 * tiny));
  EXPECT_TRUE(triangulation.inner_triangles().empty());
}

TEST(PlanarTriangulation, TakesThinBox) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed_text(seed));
    Random random(seed);
    const PlaneBox thin = seed % 2 == 0 ? box(0, 0, 1, 1e-6) : box(5, -2, 5 + 1e-6, -1);
    Checked checked(thin);
    const std::vector<std::size_t> rectangle = checked.add_rectangle(thin);
    add_random_points(checked, random, thin, 60);
    for (int i = 0; i < 40; ++i) {
      checked.connect(random_index(random, checked.point_count()),
                      random_index(random, checked.point_count()), false);
    }
    add_random_points(checked, random, thin, 60);
    checked.expect_right();
    EXPECT_EQ(checked.doubled_inner_area(), checked.doubled_area(rectangle));
  }
}

// ==== Segments

TEST(PlanarTriangulation, RefusesCrossingSegmentsAndStaysAsItWas) {
  Checked checked(unit_square);
  const std::vector<std::size_t> corners = checked.add_rectangle(unit_square);
  ASSERT_TRUE(checked.connect(corners[0], corners[2], false));
  const std::vector<Triple> before = checked.triangulation().inner_triangles();
  EXPECT_FALSE(checked.connect(corners[1], corners[3]));
  EXPECT_EQ(checked.triangulation().inner_triangles(), before);
  EXPECT_FALSE(checked.triangulation().is_on_segment(corners[1], corners[3]));

  // Free at first and blocked only behind the middle of the left side.
  const std::size_t left = checked.add(0.25, 0.5);
  const std::size_t leftmost = checked.add(0.125, 0.5);
  const std::size_t right = checked.add(0.75, 0.5);
  EXPECT_FALSE(checked.connect(leftmost, right, false));
  EXPECT_FALSE(checked.triangulation().is_on_segment(leftmost, left));
  checked.expect_right();

  // Through the point where they would cross.
  checked.add(0.5, 0.5);
  EXPECT_TRUE(checked.connect(corners[1], corners[3], false));
  EXPECT_TRUE(checked.connect(leftmost, right, false));
  checked.expect_right();
}

TEST(PlanarTriangulation, SplitsSegmentsAtPointsAddedBeforeAndAfter) {
  Checked checked(unit_square);
  const std::vector<std::size_t> square = checked.add_rectangle(unit_square);
  const std::size_t before = checked.add(0.25, 0.25);
  ASSERT_TRUE(checked.connect(square[0], square[2], false));
  const std::size_t after = checked.add(0.75, 0.75);
  const std::size_t below = checked.add(0.5, 0.0);
  const PlanarTriangulation& triangulation = checked.triangulation();
  EXPECT_TRUE(triangulation.is_on_segment(square[0], before));
  EXPECT_TRUE(triangulation.is_on_segment(before, after));
  EXPECT_TRUE(triangulation.is_on_segment(square[2], after));
  EXPECT_FALSE(triangulation.is_on_segment(before, square[2]));
  EXPECT_TRUE(triangulation.is_on_segment(square[0], below));
  EXPECT_FALSE(triangulation.is_on_segment(square[0], square[1]));
  EXPECT_FALSE(triangulation.is_on_segment(before, below));
  checked.expect_right();
  EXPECT_EQ(checked.doubled_inner_area(), checked.doubled_area(square));
}

TEST(PlanarTriangulation, CrossesManyEdgesAtOnce) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed_text(seed));
    Random random(seed);
    Checked checked(unit_square);
    checked.add_rectangle(unit_square);
    const std::size_t left = checked.add(0, 0.5);
    const std::size_t right = checked.add(1, 0.5);
    // Most of them close to the segment, on both sides, in narrow cavities with dangling edges.
    for (int i = 0; i < 100; ++i) {
      const double height = test::log_uniform(random, 1e-7, 0.5);
      checked.add(uniform(random, 0, 1), 0.5 + (random() % 2 == 0 ? height : -height));
    }
    ASSERT_TRUE(checked.connect(left, right, false));
    checked.expect_right();
  }
}

/// Points of a small grid: hardly a segment that is not through points, along others or across.
TEST(PlanarTriangulation, TakesRandomSegmentsOnSmallGrid) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed_text(seed));
    Random random(seed);
    Checked checked(box(0, 0, 8, 8));
    const std::vector<std::size_t> square = checked.add_rectangle(box(0, 0, 8, 8));
    for (int i = 0; i < 80; ++i) {
      if (random() % 2 == 0) {
        checked.add(static_cast<double>(random() % 9), static_cast<double>(random() % 9));
      } else {
        checked.connect(random_index(random, checked.point_count()),
                        random_index(random, checked.point_count()), false);
      }
    }
    checked.expect_right();
    EXPECT_EQ(checked.doubled_inner_area(), checked.doubled_area(square));
  }
}

TEST(PlanarTriangulation, TakesRandomSegmentsAndPointsInAnyOrder) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed_text(seed));
    Random random(seed);
    Checked checked(unit_square);
    const std::vector<std::size_t> square = checked.add_rectangle(unit_square);
    for (int i = 0; i < 25; ++i) {
      add_random_points(checked, random, unit_square, 4);
      checked.connect(random_index(random, checked.point_count()),
                      random_index(random, checked.point_count()), false);
    }
    checked.expect_right();
    EXPECT_EQ(checked.doubled_inner_area(), checked.doubled_area(square));
  }
}

// ==== Inside and outside

TEST(PlanarTriangulation, LeavesOutHolesAndTakesIslandsInThem) {
  Checked checked(unit_square);
  const std::vector<std::size_t> outer = checked.add_polygon(rectangle(0, 0, 1, 1));
  const std::vector<std::size_t> hole = checked.add_polygon(rectangle(0.25, 0.25, 0.75, 0.75));
  checked.expect_right();
  EXPECT_EQ(checked.doubled_inner_area(), checked.doubled_area(outer) - checked.doubled_area(hole));
  EXPECT_EQ(checked.triangle_count(), 8u);
  const std::vector<std::size_t> island = checked.add_polygon(rectangle(0.375, 0.375, 0.5, 0.625));
  Random random(1);
  add_random_points(checked, random, unit_square, 100);
  checked.expect_right();
  EXPECT_EQ(checked.doubled_inner_area(), checked.doubled_area(outer) - checked.doubled_area(hole) +
                                              checked.doubled_area(island));
}

TEST(PlanarTriangulation, HasInsideOnBothSidesOfSeam) {
  Checked checked(unit_square);
  const std::vector<std::size_t> square = checked.add_rectangle(unit_square);
  const std::size_t tip = checked.add(0.5, 0.5);
  ASSERT_TRUE(checked.connect(square[0], tip));
  ASSERT_TRUE(checked.connect(tip, square[0]));
  checked.expect_right();
  EXPECT_EQ(checked.doubled_inner_area(), checked.doubled_area(square));
  checked.add(0.25, 0.25);  // both halves are borders twice, again
  checked.expect_right();
  EXPECT_EQ(checked.doubled_inner_area(), checked.doubled_area(square));
}

TEST(PlanarTriangulation, HasInsideOnBothSidesOfClosedBorderAddedTwice) {
  Checked checked(unit_square);
  const std::vector<std::size_t> square = checked.add_rectangle(unit_square);
  checked.add_polygon(rectangle(0.25, 0.25, 0.75, 0.75));
  const std::vector<std::size_t> loop = checked.add_polygon(rectangle(0.25, 0.25, 0.75, 0.75));
  checked.expect_right();
  EXPECT_EQ(checked.doubled_inner_area(), checked.doubled_area(square));
  checked.add_polygon(rectangle(0.25, 0.25, 0.75, 0.75));
  checked.expect_right();
  EXPECT_EQ(checked.doubled_inner_area(),
            checked.doubled_area(square) - checked.doubled_area(loop));
}

TEST(PlanarTriangulation, DoesNotEndInsideAtSegmentThatIsNoBorder) {
  Checked checked(unit_square);
  const std::vector<std::size_t> square = checked.add_rectangle(unit_square);
  checked.add_polygon(rectangle(0.25, 0.25, 0.75, 0.75), false);
  checked.expect_right();
  EXPECT_EQ(checked.doubled_inner_area(), checked.doubled_area(square));
  // Borders over the same edges make it a hole.
  const std::vector<std::size_t> hole = checked.add_polygon(rectangle(0.25, 0.25, 0.75, 0.75));
  checked.expect_right();
  EXPECT_EQ(checked.doubled_inner_area(),
            checked.doubled_area(square) - checked.doubled_area(hole));
}

TEST(PlanarTriangulation, FillsStarsWithStarsInside) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed_text(seed));
    Random random(seed);
    const PlaneBox square = box(-1, -1, 1, 1);
    Checked checked(square);
    add_random_points(checked, random, square, 40);
    const std::vector<std::size_t> outer =
        checked.add_polygon(star(random, Point::Zero(), 1.0, 60));
    const std::vector<std::size_t> hole =
        checked.add_polygon(star(random, Point::Zero(), 0.09, 30));
    add_random_points(checked, random, square, 40);
    checked.expect_right();
    const std::int64_t area = checked.doubled_area(outer) - checked.doubled_area(hole);
    EXPECT_NEAR(static_cast<double>(checked.doubled_inner_area()), static_cast<double>(area),
                1e-6 * static_cast<double>(area));
  }
}

// ==== Many

TEST(PlanarTriangulation, TakesManyPointsAlongLongSegments) {
  constexpr int lines = 100;
  Random random(7);
  PlanarTriangulation triangulation(unit_square);
  std::vector<std::size_t> square;
  for (const Point& corner : rectangle(0, 0, 1, 1)) {
    square.push_back(triangulation.add_point(corner));
  }
  for (int i = 0; i < lines; ++i) {
    for (int j = 0; j < lines; ++j) {
      triangulation.add_point(
          Point((i + uniform(random, 0, 1)) / lines, (j + uniform(random, 0, 1)) / lines));
    }
  }
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(triangulation.add_segment(square[i], square[(i + 1) % 4]));
  }
  for (int i = 0; i < lines; ++i) {
    const double y = (i + 0.5) / lines;
    const std::size_t left = triangulation.add_point(Point(0, y));
    const std::size_t right = triangulation.add_point(Point(1, y));
    ASSERT_TRUE(triangulation.add_segment(left, right, false));
  }
  const std::size_t points = 4 + lines * lines + 2 * lines;
  EXPECT_EQ(triangulation.add_point(Point(0, 0)), 0u);
  EXPECT_EQ(triangulation.inner_triangles().size(), 2 * points - 2 - (4 + 2 * lines));
}

}  // namespace
}  // namespace meshgrow
