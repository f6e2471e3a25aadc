#include "sized_facets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "start_sizes/fixed_start_sizes.h"
#include "start_sizes/mesh_start_sizes.h"

namespace meshgrow {
namespace {

constexpr double slope = 1.0 / 6.0;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Sides 3, 4 and 5.
const std::array<Vec3, 3> right_triangle = {Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(0, 4, 0)};

/// Sides 6, √13, 4 and 3; the diagonal from the first to the third corner is 5 long, the other 3
/// √5.
const std::array<Vec3, 4> quad = {Vec3(0, 0, 0), Vec3(6, 0, 0), Vec3(4, 3, 0), Vec3(0, 3, 0)};

SizedFacets mesh_facets(const FacetedSource& source, QuadSize quad_size = QuadSize::triangles) {
  SizedFacets facets;
  const DroppedFacets dropped = append_mesh_start_sizes(source, quad_size, slope, facets);
  EXPECT_EQ(dropped.zero_size, 0u);
  EXPECT_EQ(dropped.not_finite, 0u);
  return facets;
}

TEST(MeshStartSizes, SegmentHasItsLength) {
  FacetedSource source;
  source.segments = {{Vec3(1, 1, 1), Vec3(3, 4, 7)}};
  const SizedFacets facets = mesh_facets(source);
  ASSERT_EQ(facets.size(), 1u);
  EXPECT_EQ(facets[0].start_size, 7.0);
  EXPECT_EQ(facets[0].slope, slope);
  EXPECT_EQ(facets[0].facet.corner_count, 2);
  EXPECT_EQ(facets[0].facet.corners[0], Vec3(1, 1, 1));
  EXPECT_EQ(facets[0].facet.corners[1], Vec3(3, 4, 7));
}

TEST(MeshStartSizes, TriangleHasTheMeanOfItsSides) {
  FacetedSource source;
  source.triangles = {right_triangle};
  const SizedFacets facets = mesh_facets(source);
  ASSERT_EQ(facets.size(), 1u);
  EXPECT_DOUBLE_EQ(facets[0].start_size, 4.0);
  EXPECT_EQ(facets[0].slope, slope);
  EXPECT_EQ(facets[0].facet.corner_count, 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(facets[0].facet.corners[i], right_triangle[i]);
  }
}

TEST(MeshStartSizes, QuadIsSizedByTheSidesOfEachHalf) {
  FacetedSource source;
  source.quads = {quad};
  const SizedFacets facets = mesh_facets(source, QuadSize::triangles);
  ASSERT_EQ(facets.size(), 2u);
  EXPECT_DOUBLE_EQ(facets[0].start_size, (6.0 + std::sqrt(13.0) + 5.0) / 3.0);
  EXPECT_DOUBLE_EQ(facets[1].start_size, (5.0 + 4.0 + 3.0) / 3.0);
}

TEST(MeshStartSizes, QuadIsSizedByItsFourSides) {
  FacetedSource source;
  source.quads = {quad};
  const SizedFacets facets = mesh_facets(source, QuadSize::sides);
  ASSERT_EQ(facets.size(), 2u);
  const double mean = (6.0 + std::sqrt(13.0) + 4.0 + 3.0) / 4.0;
  EXPECT_DOUBLE_EQ(facets[0].start_size, mean);
  EXPECT_DOUBLE_EQ(facets[1].start_size, mean);
}

TEST(MeshStartSizes, HalvesCoverTheQuad) {
  for (const QuadSize rule : {QuadSize::triangles, QuadSize::sides}) {
    FacetedSource source;
    source.quads = {quad};
    const SizedFacets facets = mesh_facets(source, rule);
    for (double u = 0.05; u < 1.0; u += 0.1) {
      for (double v = 0.05; v < 1.0; v += 0.1) {
        const Vec3 p = (1 - u) * ((1 - v) * quad[0] + v * quad[3]) +  //
                       u * ((1 - v) * quad[1] + v * quad[2]);
        EXPECT_LT(std::min(distance(facets[0].facet, p), distance(facets[1].facet, p)), 1e-14)
            << p.transpose();
      }
    }
    // They meet at the diagonal and nowhere else: away from it, a point is on one of them.
    EXPECT_GT(distance(facets[1].facet, Vec3(4, 1, 0)), 0.5);
    EXPECT_GT(distance(facets[0].facet, Vec3(1, 2, 0)), 0.5);
  }
}

TEST(MeshStartSizes, AppendsAndLeavesPointsOut) {
  FacetedSource source;
  source.points = {Vec3(0, 0, 0)};
  source.segments = {{Vec3(0, 0, 0), Vec3(1, 0, 0)}};
  source.triangles = {right_triangle};
  source.quads = {quad};
  SizedFacets facets = {{Facet::point({5, 5, 5}), 0.5, 0.0}};
  append_mesh_start_sizes(source, QuadSize::triangles, slope, facets);
  ASSERT_EQ(facets.size(), 5u);
  EXPECT_EQ(facets[0].start_size, 0.5);
}

TEST(MeshStartSizes, CollapsedElementsAreDroppedAndCounted) {
  const Vec3 a(1, 2, 3);
  FacetedSource source;
  source.segments = {{a, a}, {a, Vec3(2, 2, 3)}};
  source.triangles = {{a, a, a}, right_triangle};
  source.quads = {{a, a, a, a}};
  SizedFacets facets;
  const DroppedFacets dropped = append_mesh_start_sizes(source, QuadSize::triangles, slope, facets);
  EXPECT_EQ(dropped.zero_size, 4u);  // the quad counts for its two halves
  EXPECT_EQ(dropped.not_finite, 0u);
  ASSERT_EQ(facets.size(), 2u);
  EXPECT_EQ(facets[0].start_size, 1.0);
  EXPECT_DOUBLE_EQ(facets[1].start_size, 4.0);
}

TEST(MeshStartSizes, ElementsWithoutAreaButWithSidesAreKept) {
  FacetedSource source;
  source.triangles = {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(3, 0, 0)}};
  const SizedFacets facets = mesh_facets(source);
  ASSERT_EQ(facets.size(), 1u);
  EXPECT_DOUBLE_EQ(facets[0].start_size, 2.0);
}

TEST(MeshStartSizes, CoordinatesThatAreNotFiniteAreDroppedAndCounted) {
  for (const double bad : {not_a_number, infinite, -infinite}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 p(1, 2, 3);
      p[axis] = bad;
      FacetedSource source;
      source.segments = {{Vec3(0, 0, 0), p}};
      source.triangles = {{Vec3(0, 0, 0), p, Vec3(1, 0, 0)}};
      source.quads = {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), p}};
      SizedFacets facets;
      const DroppedFacets dropped =
          append_mesh_start_sizes(source, QuadSize::triangles, slope, facets);
      EXPECT_EQ(dropped.not_finite, 3u);
      EXPECT_EQ(dropped.zero_size, 0u);
      ASSERT_EQ(facets.size(), 1u);  // the half of the quad without the bad corner
      EXPECT_DOUBLE_EQ(facets[0].start_size, (2.0 + std::sqrt(2.0)) / 3.0);
    }
  }
}

TEST(FixedStartSizes, EveryPieceHasTheGivenSize) {
  FacetedSource source;
  source.points = {Vec3(7, 0, 0), Vec3(8, 0, 0)};
  source.segments = {{Vec3(0, 0, 0), Vec3(1, 0, 0)}};
  source.triangles = {right_triangle};
  source.quads = {quad};
  SizedFacets facets = {{Facet::point({5, 5, 5}), 3.0, 0.0}};
  const DroppedFacets dropped = append_fixed_start_sizes(source, 0.25, slope, facets);
  EXPECT_EQ(dropped.zero_size, 0u);
  EXPECT_EQ(dropped.not_finite, 0u);
  ASSERT_EQ(facets.size(), 7u);
  EXPECT_EQ(facets[0].start_size, 3.0);
  int points = 0;
  for (std::size_t i = 1; i < facets.size(); ++i) {
    EXPECT_EQ(facets[i].start_size, 0.25);
    EXPECT_EQ(facets[i].slope, slope);
    points += facets[i].facet.corner_count == 1 ? 1 : 0;
  }
  EXPECT_EQ(points, 2);
}

TEST(FixedStartSizes, CollapsedPiecesKeepTheGivenSize) {
  const Vec3 a(1, 2, 3);
  FacetedSource source;
  source.segments = {{a, a}};
  source.triangles = {{a, a, a}};
  SizedFacets facets;
  const DroppedFacets dropped = append_fixed_start_sizes(source, 0.25, slope, facets);
  EXPECT_EQ(dropped.zero_size, 0u);
  EXPECT_EQ(facets.size(), 2u);
}

TEST(FixedStartSizes, CoordinatesThatAreNotFiniteAreDroppedAndCounted) {
  const Vec3 bad(0, not_a_number, 0);
  FacetedSource source;
  source.points = {bad, Vec3(0, 0, 0)};
  source.segments = {{Vec3(0, 0, 0), bad}};
  source.triangles = {{bad, Vec3(1, 0, 0), Vec3(0, 1, 0)}};
  SizedFacets facets;
  const DroppedFacets dropped = append_fixed_start_sizes(source, 0.25, slope, facets);
  EXPECT_EQ(dropped.not_finite, 3u);
  EXPECT_EQ(facets.size(), 1u);
}

TEST(AppendFacet, StartSizeMustBePositiveAndFinite) {
  SizedFacets facets;
  DroppedFacets dropped;
  const Facet facet = Facet::segment({0, 0, 0}, {1, 0, 0});
  append_facet(facet, 0.0, slope, facets, dropped);
  append_facet(facet, -1.0, slope, facets, dropped);
  EXPECT_EQ(dropped.zero_size, 2u);
  append_facet(facet, not_a_number, slope, facets, dropped);
  append_facet(facet, infinite, slope, facets, dropped);
  EXPECT_EQ(dropped.not_finite, 2u);
  EXPECT_TRUE(facets.empty());
  append_facet(facet, 1e-300, slope, facets, dropped);
  EXPECT_EQ(facets.size(), 1u);
  EXPECT_EQ(dropped.zero_size + dropped.not_finite, 4u);
}

TEST(SizedFacet, SizeGrowsWithTheDistance) {
  const SizedFacet facet{Facet::segment({0, 0, 0}, {1, 0, 0}), 0.5, 0.25};
  EXPECT_EQ(facet.size_at({0.5, 0, 0}), 0.5);
  EXPECT_EQ(facet.size_at({0.5, 4, 0}), 1.5);
  EXPECT_EQ(facet.size_at({4, 4, 0}), 1.75);
}

}  // namespace
}  // namespace meshgrow
