#include "mapped_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace meshgrow {
namespace {

using Tags = std::vector<int>;
using Pairs = std::vector<OppositeSides>;

const Entity surface = {2, 1};

std::vector<Entity> curves(const Tags& tags) {
  std::vector<Entity> result;
  for (const int tag : tags) {
    result.push_back({1, tag});
  }
  return result;
}

void add_curve(Topology& topology, int tag, const Tags& points, double length = 1.0) {
  std::vector<Entity> ends;
  for (const int point : points) {
    topology.add_entity({0, point}, {});
    ends.push_back({0, point});
  }
  topology.add_entity({1, tag}, ends, Box(Vec3(0, 0, 0), Vec3(length, 0, 0)));
}

/// Curves 1 to `count` in a ring; curve i goes from point i to the next point.
Topology polygon(int count) {
  Topology topology;
  for (int i = 1; i <= count; ++i) {
    add_curve(topology, i, {i, i % count + 1});
  }
  return topology;
}

Tags up_to(int count) {
  Tags result;
  for (int i = 1; i <= count; ++i) {
    result.push_back(i);
  }
  return result;
}

Pairs pairs(const Topology& topology, const Tags& boundary, const Tags& corners = {},
            bool equal_triangles = false) {
  return opposite_sides({surface, curves(boundary), corners}, topology, equal_triangles);
}

/// As sets of pairs of sets: neither the order of the pairs nor that of sides or curves says
/// anything.
using Unordered = std::set<std::set<std::set<int>>>;

Unordered unordered(const Pairs& pairs) {
  Unordered result;
  for (const OppositeSides& pair : pairs) {
    EXPECT_EQ(pair.surface, surface);
    std::set<std::set<int>> sides;
    for (const std::vector<Entity>* side : {&pair.first, &pair.second}) {
      std::set<int> tags;
      for (const Entity& curve : *side) {
        EXPECT_EQ(curve.dim, 1);
        EXPECT_TRUE(tags.insert(curve.tag).second) << entity_name(curve) << " twice";
      }
      sides.insert(tags);
    }
    EXPECT_TRUE(result.insert(sides).second) << "a pair twice";
  }
  return result;
}

// ==== Four sides

TEST(MappedSurface, OppositeCurvesOfARectangle) {
  EXPECT_EQ(unordered(pairs(polygon(4), {1, 2, 3, 4})), (Unordered{{{1}, {3}}, {{2}, {4}}}));
}

TEST(MappedSurface, TheOrderOfTheCurvesSaysNothingOfARectangle) {
  const Topology topology = polygon(4);
  Tags order = up_to(4);
  do {
    SCOPED_TRACE(entity_names(curves(order)));
    EXPECT_EQ(unordered(pairs(topology, order)), (Unordered{{{1}, {3}}, {{2}, {4}}}));
    Tags corners = up_to(4);
    do {
      EXPECT_EQ(unordered(pairs(topology, order, corners)), (Unordered{{{1}, {3}}, {{2}, {4}}}));
    } while (std::next_permutation(corners.begin(), corners.end()));
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(MappedSurface, SidesOfSeveralCurvesGoFromCornerToCorner) {
  // Sides 1, 2 3, 4 5 6, 7.
  const Topology topology = polygon(7);
  const Unordered expected = {{{1}, {4, 5, 6}}, {{2, 3}, {7}}};
  Tags order = up_to(7);
  for (int rotation = 0; rotation < 7; ++rotation) {
    for (Tags corners : {Tags{1, 2, 4, 7}, Tags{4, 7, 1, 2}, Tags{7, 4, 2, 1}}) {
      EXPECT_EQ(unordered(pairs(topology, order, corners)), expected);
      const Tags backwards(order.rbegin(), order.rend());
      EXPECT_EQ(unordered(pairs(topology, backwards, corners)), expected);
    }
    std::rotate(order.begin(), order.begin() + 1, order.end());
  }
  EXPECT_EQ(unordered(pairs(topology, {5, 1, 7, 3, 2, 6, 4}, {1, 2, 4, 7})), expected);
}

TEST(MappedSurface, CurvesOfASideStandInARow) {
  const Pairs found = pairs(polygon(7), {5, 1, 7, 3, 2, 6, 4}, {1, 2, 4, 7});
  ASSERT_EQ(found.size(), 2u);
  for (const OppositeSides& pair : found) {
    for (const std::vector<Entity>& side : {pair.first, pair.second}) {
      if (side.size() == 3) {
        EXPECT_EQ(side[1], (Entity{1, 5}));
      }
    }
  }
}

TEST(MappedSurface, MoreThanFourCurvesNeedCorners) {
  EXPECT_TRUE(pairs(polygon(5), up_to(5)).empty());
  EXPECT_TRUE(pairs(polygon(8), up_to(8)).empty());
}

// ==== Three sides

TEST(MappedSurface, ATriangleHasTwoEqualSidesAtItsFirstCorner) {
  const Topology topology = polygon(3);
  EXPECT_EQ(unordered(pairs(topology, {1, 2, 3}, {1, 2, 3})), (Unordered{{{1}, {3}}}));
  EXPECT_EQ(unordered(pairs(topology, {1, 2, 3}, {2, 3, 1})), (Unordered{{{1}, {2}}}));
  EXPECT_EQ(unordered(pairs(topology, {1, 2, 3}, {3, 2, 1})), (Unordered{{{2}, {3}}}));
  EXPECT_EQ(unordered(pairs(topology, {2, 1, 3}, {1, 3, 2})), (Unordered{{{1}, {3}}}));
}

TEST(MappedSurface, WithoutCornersATriangleBeginsWhereItsFirstAndLastCurveMeet) {
  const Topology topology = polygon(3);
  EXPECT_EQ(unordered(pairs(topology, {1, 2, 3})), (Unordered{{{1}, {3}}}));
  EXPECT_EQ(unordered(pairs(topology, {2, 3, 1})), (Unordered{{{1}, {2}}}));
  EXPECT_EQ(unordered(pairs(topology, {3, 1, 2})), (Unordered{{{2}, {3}}}));
}

TEST(MappedSurface, EqualTrianglesHaveThreeEqualSides) {
  for (const Tags& corners : {Tags{}, Tags{1, 2, 3}, Tags{3, 1, 2}}) {
    const Pairs found = pairs(polygon(3), {1, 2, 3}, corners, true);
    ASSERT_EQ(found.size(), 2u);
    std::set<int> all;
    for (const std::set<std::set<int>>& sides : unordered(found)) {
      EXPECT_EQ(sides.size(), 2u);
      for (const std::set<int>& side : sides) {
        all.insert(side.begin(), side.end());
      }
    }
    EXPECT_EQ(all, (std::set<int>{1, 2, 3}));
  }
  // Rectangles are none of it.
  EXPECT_EQ(unordered(pairs(polygon(4), up_to(4), {}, true)), (Unordered{{{1}, {3}}, {{2}, {4}}}));
}

TEST(MappedSurface, TriangleWithSidesOfSeveralCurves) {
  // Sides 1 2, 3, 4 5.
  const Topology topology = polygon(5);
  EXPECT_EQ(unordered(pairs(topology, up_to(5), {1, 3, 4})), (Unordered{{{1, 2}, {4, 5}}}));
  EXPECT_EQ(unordered(pairs(topology, up_to(5), {4, 1, 3})), (Unordered{{{3}, {4, 5}}}));
  EXPECT_EQ(unordered(pairs(topology, up_to(5), {1, 3, 4}, true)),
            (Unordered{{{1, 2}, {4, 5}}, {{1, 2}, {3}}}));
}

TEST(MappedSurface, ThreeCornersOfARectangleMakeATriangle) {
  EXPECT_EQ(unordered(pairs(polygon(4), up_to(4), {1, 2, 3})), (Unordered{{{1}, {3, 4}}}));
}

// ==== Curves without length

TEST(MappedSurface, CurvesWithoutLengthAreNoSides) {
  // As of a cap of a sphere: a pole between curves 3 and 1, where Gmsh's box is a tolerance wide.
  Topology topology;
  add_curve(topology, 1, {1, 2});
  add_curve(topology, 2, {2, 3});
  add_curve(topology, 3, {3, 1});
  add_curve(topology, 4, {1}, 2e-7);
  EXPECT_EQ(unordered(pairs(topology, {1, 2, 3, 4})), (Unordered{{{1}, {3}}}));
  EXPECT_EQ(unordered(pairs(topology, {4, 1, 2, 3})), (Unordered{{{1}, {3}}}));
  EXPECT_EQ(unordered(pairs(topology, {2, 3, 4, 1}, {1, 2, 3})), (Unordered{{{1}, {3}}}));
}

TEST(MappedSurface, ShortCurvesWithTwoEndsAreSides) {
  Topology topology = polygon(4);
  add_curve(topology, 2, {2, 3}, 1e-9);
  EXPECT_EQ(unordered(pairs(topology, up_to(4))), (Unordered{{{1}, {3}}, {{2}, {4}}}));
}

// ==== What cannot be mapped

TEST(MappedSurface, NothingForSurfacesWithHoles) {
  Topology topology = polygon(4);
  for (int i = 5; i <= 8; ++i) {
    add_curve(topology, i, {i, i == 8 ? 5 : i + 1});
  }
  EXPECT_TRUE(pairs(topology, up_to(8)).empty());
  EXPECT_TRUE(pairs(topology, up_to(8), {1, 2, 3, 4}).empty());
  add_curve(topology, 9, {9});
  EXPECT_TRUE(pairs(topology, {1, 2, 3, 4, 9}, {1, 2, 3, 4}).empty());
  EXPECT_TRUE(pairs(topology, {9, 1, 2, 3, 4}, {1, 2, 3, 4}).empty());
  // A triangle around a closed curve has four curves, too.
  Topology triangle = polygon(3);
  add_curve(triangle, 4, {4});
  EXPECT_TRUE(pairs(triangle, {1, 2, 3, 4}).empty());
  EXPECT_TRUE(pairs(triangle, {4, 1, 2, 3}).empty());
}

TEST(MappedSurface, NothingForCornersOffTheBoundary) {
  const Topology topology = polygon(4);
  EXPECT_TRUE(pairs(topology, up_to(4), {9, 1, 2, 3}).empty());
  EXPECT_TRUE(pairs(topology, up_to(4), {1, 2, 3, 9}).empty());
  EXPECT_TRUE(pairs(polygon(5), up_to(5), {1, 2, 3, 9}).empty());
  EXPECT_TRUE(pairs(polygon(3), {1, 2, 3}, {1, 2, 9}).empty());
}

TEST(MappedSurface, NothingForCornersNamedTwice) {
  EXPECT_TRUE(pairs(polygon(4), up_to(4), {1, 2, 3, 3}).empty());
  EXPECT_TRUE(pairs(polygon(4), up_to(4), {1, 1, 2, 3}).empty());
}

TEST(MappedSurface, NothingForClosedCurves) {
  Topology topology;
  add_curve(topology, 1, {1});
  EXPECT_TRUE(pairs(topology, {1}).empty());
  EXPECT_TRUE(pairs(topology, {1}, {1, 1, 1}).empty());
  add_curve(topology, 2, {2, 3});
  add_curve(topology, 3, {3, 2});
  EXPECT_TRUE(pairs(topology, {2, 3}).empty());
  // A closed curve that hangs at the corner of a triangle.
  Topology triangle = polygon(3);
  add_curve(triangle, 4, {1});
  for (const Tags& order : {Tags{1, 2, 3, 4}, Tags{4, 1, 2, 3}, Tags{1, 4, 2, 3}}) {
    EXPECT_TRUE(pairs(triangle, order).empty());
    EXPECT_TRUE(pairs(triangle, order, {1, 2, 3}).empty());
  }
}

TEST(MappedSurface, NothingForSeams) {
  // A cylinder: two closed curves and the seam between them, once on each of its sides.
  Topology topology;
  add_curve(topology, 1, {1});
  add_curve(topology, 2, {1, 2});
  add_curve(topology, 3, {2});
  Tags order = {1, 2, 2, 3};
  do {
    EXPECT_TRUE(pairs(topology, order).empty()) << entity_names(curves(order));
    EXPECT_TRUE(pairs(topology, order, {1, 2, 1, 2}).empty());
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_TRUE(pairs(topology, {1, 2, 3}).empty());
}

TEST(MappedSurface, NothingForCurvesThatDoNotClose) {
  Topology topology = polygon(5);
  EXPECT_TRUE(pairs(topology, {1, 2, 3, 4}).empty());
  EXPECT_TRUE(pairs(topology, {1, 2, 3}).empty());
  EXPECT_TRUE(pairs(topology, {}).empty());
}

}  // namespace
}  // namespace meshgrow
