#include "start_sizes/curvature_start_sizes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace meshgrow {
namespace {

constexpr double slope = 1.0 / 6.0;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
const double pi = std::acos(-1.0);

/// A strip of a cylinder about the z axis: `count` quads of `step` degrees each.
FacetedSource strip(double radius, int count, double step) {
  FacetedSource source;
  const auto at = [&](int i, double z) {
    const double angle = std::fmod(i * step, 360.0) * pi / 180.0;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  for (int i = 0; i < count; ++i) {
    source.quads.push_back({at(i, 0), at(i + 1, 0), at(i + 1, 3), at(i, 3)});
  }
  return source;
}

SizedFacets sized(const FacetedSource& source, const CurvatureParameters& parameters,
                  std::size_t dropped = 0) {
  SizedFacets facets;
  const DroppedFacets result = append_curvature_start_sizes(source, parameters, slope, facets);
  EXPECT_EQ(result.zero_size + result.not_finite, dropped);
  return facets;
}

TEST(CurvatureStartSizes, ChordOfTheAngle) {
  EXPECT_NEAR(curvature_start_size(0.5, 60.0), 2.0, 1e-15);
  EXPECT_NEAR(curvature_start_size(2.0, 18.0), std::sin(9.0 * pi / 180.0), 1e-15);
  EXPECT_EQ(curvature_start_size(0.0, 18.0), std::numeric_limits<double>::infinity());
}

TEST(CurvatureStartSizes, KnownCurvatureOfTheGeometryIsTaken) {
  FacetedSource source;
  source.segments = {{Vec3(0, 0, 0), Vec3(1, 0, 0)}, {Vec3(1, 0, 0), Vec3(2, 0, 0)}};
  source.segment_curvatures = {2.0, 0.0};
  source.triangles = {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}};
  source.triangle_curvatures = {4.0};
  const SizedFacets facets = sized(source, {60.0, 0.0, 10.0});
  ASSERT_EQ(facets.size(), 2u) << "a straight piece gives no facet";
  EXPECT_NEAR(facets[0].start_size, 0.5, 1e-15);
  EXPECT_NEAR(facets[1].start_size, 0.25, 1e-15);
  EXPECT_EQ(facets[1].slope, slope);
  EXPECT_EQ(facets[1].facet, Facet::triangle(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)));
}

TEST(CurvatureStartSizes, UnknownCurvatureIsThatOfTheFacets) {
  FacetedSource source = strip(2.0, 36, 10.0);
  for (const Facet& half : split_quad(source.quads.back())) {
    source.triangles.push_back(half.corners);  // first in the order of triangles
  }
  source.quads.pop_back();
  source.triangle_curvatures = {7.0, not_a_number};
  const SizedFacets facets = sized(source, {18.0, 0.0, 10.0});
  ASSERT_EQ(facets.size(), 72u);
  EXPECT_NEAR(facets[0].start_size, curvature_start_size(7.0, 18.0), 1e-15);
  for (std::size_t i = 1; i < facets.size(); ++i) {
    EXPECT_NEAR(facets[i].start_size, curvature_start_size(0.5, 18.0), 1e-12) << i;
  }
}

TEST(CurvatureStartSizes, MinimumAndLimit) {
  FacetedSource source;
  for (int i = 0; i < 3; ++i) {
    source.segments.push_back({Vec3(i, 0, 0), Vec3(i + 1, 0, 0)});
  }
  source.segment_curvatures = {1.0, 10.0, 100.0};  // sizes 1, 0.1 and 0.01
  const SizedFacets facets = sized(source, {60.0, 0.05, 0.5});
  ASSERT_EQ(facets.size(), 2u) << "what asks for more than the limit gives no facet";
  EXPECT_NEAR(facets[0].start_size, 0.1, 1e-15);
  EXPECT_EQ(facets[1].start_size, 0.05);
}

TEST(CurvatureStartSizes, FlatSourceGivesNoFacet) {
  FacetedSource source;
  source.quads = {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}};
  source.segments = {{Vec3(0, 0, 0), Vec3(1, 0, 0)}, {Vec3(1, 0, 0), Vec3(2, 0, 0)}};
  EXPECT_TRUE(sized(source, {18.0, 0.0, 10.0}).empty());
}

TEST(CurvatureStartSizes, EndlessCurvatureIsCountedUnlessThereIsAMinimum) {
  FacetedSource source;
  source.segments = {{Vec3(0, 0, 0), Vec3(1, 0, 0)}};
  source.segment_curvatures = {1e308};
  EXPECT_EQ(sized(source, {18.0, 0.01, 1.0}).front().start_size, 0.01);
}

}  // namespace
}  // namespace meshgrow
