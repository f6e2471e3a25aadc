#include "start_sizes/proximity_start_sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "growth_law.h"
#include "random_facets.h"
#include "start_sizes/gap_finder.h"
#include "wall_shapes.h"

namespace meshgrow {
namespace {

using test::joined;
using test::Random;
using test::Sources;

constexpr double infinity = std::numeric_limits<double>::infinity();

ProximityParameters parameters_of(double size_limit) {
  ProximityParameters parameters;
  parameters.size_limit = size_limit;
  return parameters;
}

/// The start sizes, as the gaps that they stand for: size limit and cells do not show.
SizedFacets gaps_of(const std::vector<Wall>& walls, const std::set<Entity>& sources,
                    const ProximityParameters& parameters) {
  SizedFacets facets;
  append_proximity_start_sizes(walls, sources, parameters, facets);
  const double of_unit = gap_start_size(1.0, parameters.cells_per_gap, parameters.growth_rate);
  for (SizedFacet& facet : facets) {
    EXPECT_EQ(facet.slope, growth_slope(parameters.growth_rate));
    EXPECT_LT(facet.start_size, parameters.size_limit);
    EXPECT_GE(facet.start_size, parameters.min_size);
    facet.start_size /= of_unit;
  }
  return facets;
}

SizedFacets gaps_in(const Sources& faces, const ProximityParameters& parameters) {
  return gaps_of(volume_walls(faces), test::entities_of(faces), parameters);
}

/// Facets whose centroids the condition holds for.
SizedFacets chosen(const SizedFacets& facets, const std::function<bool(const Vec3&)>& holds) {
  SizedFacets result;
  std::copy_if(facets.begin(), facets.end(), std::back_inserter(result),
               [&](const SizedFacet& facet) { return holds(facet.facet.centroid()); });
  return result;
}

double measure(const SizedFacets& facets) {
  double sum = 0.0;
  for (const SizedFacet& facet : facets) {
    const auto& [a, b, c] = facet.facet.corners;
    sum += facet.facet.corner_count == 3 ? 0.5 * (b - a).cross(c - a).norm() : (b - a).norm();
  }
  return sum;
}

void expect_gaps(const SizedFacets& facets, double low, double high) {
  for (const SizedFacet& facet : facets) {
    ASSERT_GE(facet.start_size, low) << facet.facet.centroid().transpose();
    ASSERT_LE(facet.start_size, high) << facet.facet.centroid().transpose();
  }
}

auto at_z(double z) {
  return [z](const Vec3& p) { return std::abs(p.z() - z) < 1e-9; };
}

// ==== Start size of a gap

/// Elements across the gap: the integral of 1 / S(R), from both sides to the middle.
double cells_across(double gap, double start_size, double growth_rate) {
  constexpr int steps = 100000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double r = 0.5 * gap * (i + 0.5) / steps;
    sum += 0.5 * gap / steps / grown_size(start_size, growth_rate, r);
  }
  return 2.0 * sum;
}

TEST(GapStartSize, AsManyCellsFitAsAreAskedFor) {
  for (const double growth_rate : {1.0, 1.0 + 1e-12, 1.05, 1.2, 2.0}) {
    for (const double cells : {0.5, 1.0, 2.5, 3.0, 10.0}) {
      for (const double gap : {1e-6, 1.0, 1e6}) {
        const double size = gap_start_size(gap, cells, growth_rate);
        EXPECT_NEAR(cells_across(gap, size, growth_rate), cells, 1e-6 * cells);
        EXPECT_LE(size, gap / cells * (1.0 + 1e-12));
      }
    }
  }
  EXPECT_DOUBLE_EQ(gap_start_size(6.0, 3.0, 1.0), 2.0);
}

// ==== Plates

TEST(ProximityStartSizes, NothingFromNothing) {
  SizedFacets facets;
  append_proximity_start_sizes({}, {}, parameters_of(1.0), facets);
  append_proximity_start_sizes({}, {{2, 1}}, parameters_of(1.0), facets);
  append_proximity_start_sizes(volume_walls(test::box_faces({0, 0, 0}, {1, 1, 1})), {},
                               parameters_of(1.0), facets);
  EXPECT_TRUE(facets.empty());
}

TEST(ProximityStartSizes, ParallelPlatesAtAnyScaleAndInAnyPosition) {
  constexpr unsigned seed = 31;
  Random random(seed);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const int n : {1, 7, 40}) {
      const Eigen::AngleAxisd turn(test::uniform(random, 0.0, 3.0), test::random_direction(random));
      const Vec3 offset = 30.0 * scale * test::random_in_ball(random, 1.0);
      const Sources faces =
          test::moved(test::box_faces({0, 0, 0}, {10, 10, 1}, n),
                      [&](const Vec3& p) { return Vec3(scale * (turn * p) + offset); });
      const SizedFacets facets = gaps_in(faces, parameters_of(20.0 * scale));
      const auto on_plate = [&](const Vec3& p) {
        const double z = (turn.inverse() * ((p - offset) / scale)).z();
        return std::abs(z) < 1e-6 || std::abs(z - 1.0) < 1e-6;
      };
      const SizedFacets plates = chosen(facets, on_plate);
      const SizedFacets rim = chosen(facets, [&](const Vec3& p) { return !on_plate(p); });
      SCOPED_TRACE("scale " + std::to_string(scale) + ", n " + std::to_string(n) + ", seed " +
                   std::to_string(seed));
      EXPECT_NEAR(measure(plates), 200.0 * scale * scale, 1e-6 * scale * scale);
      expect_gaps(plates, scale * (1.0 - 1e-6), scale * (1.0 + 1e-6));
      EXPECT_NEAR(measure(rim), 40.0 * scale * scale, 1e-6 * scale * scale);
      expect_gaps(rim, 10.0 * scale * (1.0 - 1e-6), 10.0 * scale * (1.0 + 1e-6));
      // Not shattered: the walls themselves.
      EXPECT_EQ(facets.size(), static_cast<std::size_t>(12 * n * n));
    }
  }
}

TEST(ProximityStartSizes, LargeWallsAreCutToTheSizeLimitOnly) {
  const SizedFacets facets = gaps_in(test::box_faces({0, 0, 0}, {10, 10, 1}), parameters_of(5.0));
  EXPECT_EQ(chosen(facets, at_z(0)).size(), 16u);
  EXPECT_NEAR(measure(facets), 240.0, 1e-9);
}

TEST(ProximityStartSizes, SizeLimitLeavesOutWideGaps) {
  const Sources faces = test::box_faces({0, 0, 0}, {10, 10, 1}, 5);
  const double of_one = gap_start_size(1.0, 3.0, 1.2);
  EXPECT_NEAR(measure(gaps_in(faces, parameters_of(1.01 * of_one))), 200.0, 1e-9);
  EXPECT_EQ(gaps_in(faces, parameters_of(0.99 * of_one)).size(), 0u);
}

TEST(ProximityStartSizes, MinSizeIgnoresNarrowGaps) {
  const Sources faces = test::box_faces({0, 0, 0}, {10, 10, 1}, 5);
  ProximityParameters parameters = parameters_of(20.0);
  parameters.min_size = 1.01 * gap_start_size(1.0, 3.0, 1.2);
  const SizedFacets facets = gaps_in(faces, parameters);
  EXPECT_EQ(facets.size(), 200u);  // the rim
  expect_gaps(facets, 9.99, 10.01);
}

TEST(ProximityStartSizes, CellsNeedNotBeWhole) {
  ProximityParameters parameters = parameters_of(20.0);
  parameters.cells_per_gap = 2.5;
  parameters.growth_rate = 1.3;
  SizedFacets facets;
  const Sources faces = test::box_faces({0, 0, 0}, {10, 10, 1}, 3);
  append_proximity_start_sizes(volume_walls(faces), {{2, 5}}, parameters, facets);
  ASSERT_EQ(facets.size(), 18u);
  for (const SizedFacet& facet : facets) {
    EXPECT_NEAR(facet.start_size, gap_start_size(1.0, 2.5, 1.3), 1e-9);
    EXPECT_EQ(facet.slope, growth_slope(1.3));
  }
}

TEST(ProximityStartSizes, OnlySourcesGetFacetsButAllWallsBoundGaps) {
  const Sources faces = test::box_faces({0, 0, 0}, {10, 10, 1}, 5);
  const SizedFacets facets = gaps_of(volume_walls(faces), {{2, 6}}, parameters_of(20.0));
  EXPECT_EQ(facets.size(), 50u);
  EXPECT_EQ(chosen(facets, at_z(1)).size(), 50u);
  expect_gaps(facets, 0.999999, 1.000001);
}

TEST(ProximityStartSizes, AThirdBodyBetweenThePlatesIsSeenByBoth) {
  // Small against the plates' triangles, and not where these are sampled first.
  const Sources faces = joined(test::box_faces({0, 0, 0}, {10, 10, 1}),
                               test::box_faces({7.1, 6.3, 0.6}, {7.3, 6.5, 0.8}, 1, 11));
  const SizedFacets facets = gaps_in(faces, parameters_of(20.0));
  const auto at = [&](const Vec3& p) {
    SizedFacets there;
    std::copy_if(facets.begin(), facets.end(), std::back_inserter(there),
                 [&](const SizedFacet& facet) { return distance(facet.facet, p) < 1e-9; });
    return there;
  };
  ASSERT_FALSE(at({7.2, 6.4, 0}).empty());
  ASSERT_FALSE(at({7.2, 6.4, 1}).empty());
  expect_gaps(at({7.2, 6.4, 0}), 0.59, 0.65);
  expect_gaps(at({7.2, 6.4, 1}), 0.19, 0.22);
  expect_gaps(at({2, 2, 0}), 0.99, 1.01);
  expect_gaps(chosen(facets, at_z(0.6)), 0.594, 0.606);
  expect_gaps(chosen(facets, at_z(0.8)), 0.198, 0.202);
  EXPECT_NEAR(measure(chosen(facets, at_z(0))), 100.0, 1e-6);
}

// ==== Slanted gaps

/// A wedge of 10° about the x axis from 0 to 10, its tip cut off at x = cut if that is not 0.
Sources wedge(double cut, int n) {
  const double slope = std::tan(10.0 * test::pi / 180.0);
  test::Outline outline = {{cut, 0, 0}, {10, 0, 0}, {10, 10 * slope, 0}};
  if (cut > 0.0) {
    outline.push_back({cut, cut * slope, 0});
  }
  return test::prism(outline, 4.0, n);
}

TEST(ProximityStartSizes, WedgeHasGapsBeyondTheSizeLimitFromItsTip) {
  const double sine = std::sin(10.0 * test::pi / 180.0);
  for (const int n : {1, 4, 40}) {
    SCOPED_TRACE("n " + std::to_string(n));
    constexpr double limit = 1.0;
    const SizedFacets facets =
        gaps_of(volume_walls(wedge(0.0, n)), {{2, 3}, {2, 5}}, parameters_of(limit));
    const auto from_tip = [](const Vec3& p) { return std::hypot(p.x(), p.y()); };
    for (const SizedFacet& facet : facets) {
      const double x = from_tip(facet.facet.centroid());
      ASSERT_GT(x, 0.9 * limit);
      // The end at x = 10 cuts off what the normals of the upper side would meet beyond.
      ASSERT_NEAR(facet.start_size, x * sine, 0.05 * x * sine) << "x = " << x;
    }
    const double reach = limit / gap_start_size(1.0, 3.0, 1.2);
    const double far = std::min(10.0, reach / sine);
    const SizedFacets sure = chosen(facets, [&](const Vec3& p) { return from_tip(p) < 0.9 * far; });
    // Two sides, from the limit on: nothing is left out.
    EXPECT_NEAR(measure(sure), 2.0 * 4.0 * (0.9 * far - limit), 0.6) << n;
  }
}

TEST(ProximityStartSizes, TruncatedWedgeHasGapsEverywhere) {
  const double sine = std::sin(10.0 * test::pi / 180.0);
  for (const int n : {1, 20}) {
    const SizedFacets facets =
        gaps_of(volume_walls(wedge(0.05, n)), {{2, 3}, {2, 5}}, parameters_of(10.0));
    double nearest = 10.0;
    for (const SizedFacet& facet : facets) {
      const Vec3 p = facet.facet.centroid();
      const double x = std::hypot(p.x(), p.y());
      nearest = std::min(nearest, x);
      ASSERT_NEAR(facet.start_size, x * sine, 0.05 * x * sine) << "x = " << x;
    }
    EXPECT_LT(nearest, 0.06);
    EXPECT_NEAR(measure(facets), 4.0 * (9.95 * (1.0 + 1.0 / std::cos(10.0 * test::pi / 180.0))),
                1e-6);
  }
}

TEST(ProximityStartSizes, SphereThatStandsOnAPlane) {
  // Beyond the size limit from the point of contact there are gaps, nearer there are none.
  const FacetedSource unturned = test::sphere_face(1, {0, 0, 0}, 1.0, 4);
  const Vec3 foot = unturned.triangles[0][0];
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(foot, Vec3(0, 0, -1));
  Sources sphere = test::moved({unturned}, [&](const Vec3& p) {
    return p == foot ? Vec3(0, 0, 0) : Vec3(turn * p + Vec3(0, 0, 1));
  });
  sphere[0].entity.tag = 10;
  const Sources faces = joined(test::box_faces({-3, -3, 0}, {3, 3, 6}, 2), sphere);
  constexpr double limit = 0.3;
  const SizedFacets facets = gaps_in(faces, parameters_of(limit));
  double nearest = 10.0;
  for (const SizedFacet& facet : facets) {
    nearest = std::min(nearest, facet.facet.centroid().norm());
  }
  EXPECT_GT(nearest, 0.8 * limit);
  EXPECT_LT(nearest, 1.3 * limit);
  EXPECT_FALSE(chosen(facets, at_z(0)).empty());
}

// ==== Curved gaps

TEST(ProximityStartSizes, ConcentricSpheres) {
  for (const int levels : {2, 4}) {
    for (const double inner : {0.5, 0.9}) {
      const Sources faces = {test::sphere_face(1, {1, 2, 3}, 1.0, levels),
                             test::sphere_face(2, {1, 2, 3}, inner, levels)};
      const SizedFacets facets = gaps_in(faces, parameters_of(1.0));
      // Sides of triangles are 1.1 / 2^levels long; their middles lie lower by about their square
      // over 6.
      const double sag = 0.25 * std::pow(0.25, levels);
      expect_gaps(facets, 1.0 - inner - sag, 1.02 * (1.0 - inner) + sag);
      const double area = measure(facets);
      EXPECT_NEAR(area, 4.0 * test::pi * (1.0 + inner * inner), 5.0 * sag * area);
    }
  }
}

TEST(ProximityStartSizes, EccentricSpheresHaveTheGapOfTheirNearestPlace) {
  const Sources faces = {test::sphere_face(1, {0, 0, 0}, 1.0, 4),
                         test::sphere_face(2, {0.3, 0, 0}, 0.5, 4)};
  const SizedFacets facets = gaps_in(faces, parameters_of(1.0));
  double least = 10.0;
  for (const SizedFacet& facet : facets) {
    const Vec3 p = facet.facet.centroid();
    const bool outer = p.norm() > 0.9;
    // The inner sphere seen from the outer one, and a bound the other way.
    if (outer && (p - Vec3(0.3, 0, 0)).normalized().dot(p.normalized()) > 0.75) {
      const double expected = (p - Vec3(0.3, 0, 0)).norm() - 0.5;
      ASSERT_NEAR(facet.start_size, expected, 0.02 * expected + 0.01);
    }
    least = std::min(least, facet.start_size);
  }
  EXPECT_NEAR(least, 0.2, 0.01);
}

TEST(ProximityStartSizes, TubeInABox) {
  constexpr int sides = 48;
  const test::Outline inner = test::circle({0, 0, 0}, 0.5, sides);
  const test::Outline outer = test::circle({0, 0, 0}, 0.6, sides);
  const double height = 3.0;
  const FacetedSource bottom = test::ring_face(11, inner, outer);
  FacetedSource top =
      test::moved({bottom}, [&](const Vec3& p) { return Vec3(p + Vec3(0, 0, height)); }).front();
  top.entity.tag = 12;
  const Sources tube = {bottom, top, test::mantle_face(13, inner, height, 6),
                        test::mantle_face(14, outer, height, 6)};
  const Sources faces = joined(test::box_faces({-1, -2, -1}, {1, 2, 4}, 3), tube);
  const std::vector<Wall> walls = volume_walls(faces);
  // Across the bore, not through the tube's own wall. The closest wall whose normal opposes within
  // 45° is not the one straight opposite, but at the end of a chord cos(22.5°) times as long (a
  // little less with facets).
  const double across = std::cos(test::pi / sides);
  const SizedFacets bore = gaps_of(walls, {{2, 13}}, parameters_of(2.0));
  expect_gaps(bore, 0.89 * across, 1.001 * across);
  EXPECT_NEAR(measure(bore), sides * 2.0 * 0.5 * std::sin(test::pi / sides) * height, 1e-6);
  const SizedFacets outside = gaps_of(walls, {{2, 14}}, parameters_of(2.0));
  expect_gaps(outside, 0.39, 10.0);
  double least = 10.0;
  for (const SizedFacet& facet : outside) {
    least = std::min(least, facet.start_size);
  }
  EXPECT_NEAR(least, 0.4, 0.01);
  // The box sees the tube: 0.4 at x = ±1.
  const SizedFacets box = gaps_of(walls, {{2, 1}}, parameters_of(0.3));
  double least_of_box = 10.0;
  for (const SizedFacet& facet : box) {
    least_of_box = std::min(least_of_box, facet.start_size);
  }
  EXPECT_NEAR(least_of_box, 0.4, 0.01);
  expect_gaps(gaps_of(walls, {{2, 11}, {2, 12}}, parameters_of(2.0)), 0.99, 1.01);
}

// ==== A hole near the rim

constexpr double ligament = 0.1;  ///< between a hole of radius 1 and the rim at x = 3
const Vec3 hole_centre(3.0 - 1.0 - ligament, 0.0, 0.0);

/// Distance of a point of the hole from the rim at x = 3.
double to_rim(const Vec3& p) { return 3.0 - p.x(); }

TEST(ProximityStartSizes, HoleNearTheRimOfAPlate) {
  const Sources faces = test::plate_with_hole(test::circle(hole_centre, 1.0, 96),
                                              test::square_around(hole_centre, 3.0, 96), 2.0);
  const SizedFacets facets = gaps_of(volume_walls(faces), {{2, 3}}, parameters_of(1.0));
  const SizedFacets nearest = chosen(facets, [](const Vec3& p) { return to_rim(p) < 0.12; });
  ASSERT_FALSE(nearest.empty());
  expect_gaps(nearest, 0.095, 0.13);
  for (const SizedFacet& facet : chosen(facets, [](const Vec3& p) { return to_rim(p) < 0.3; })) {
    const Vec3 p = facet.facet.centroid();
    ASSERT_NEAR(facet.start_size, to_rim(p), 0.06 * to_rim(p)) << p.transpose();
  }
}

TEST(ProximityStartSizes, HoleNearTheRimOfAPlaneSurface) {
  constexpr unsigned seed = 41;
  Random random(seed);
  const test::Outline hole = test::circle(hole_centre, 1.0, 96);
  const test::Outline rim = test::square_around(hole_centre, 3.0, 96);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const Eigen::AngleAxisd turn(test::uniform(random, 0.0, 3.0), test::random_direction(random));
    const auto there = [&](const Vec3& p) { return Vec3(scale * (turn * p)); };
    const auto back = [&](const Vec3& p) { return Vec3(turn.inverse() * (p / scale)); };
    const FacetedSource surface = test::moved({test::ring_face(1, hole, rim)}, there).front();
    const Sources curves = test::moved({test::curve_of(1, hole), test::curve_of(2, rim)}, there);
    const std::vector<Wall> walls = surface_walls(surface, curves, {});
    ASSERT_EQ(walls.size(), 192u);
    const SizedFacets facets = gaps_of(walls, {{1, 1}, {1, 2}}, parameters_of(1.0 * scale));
    double least = infinity;
    for (const SizedFacet& facet : facets) {
      const Vec3 p = back(facet.facet.centroid());
      const double gap = facet.start_size / scale;
      least = std::min(least, gap);
      if ((p - hole_centre).norm() < 1.01 && to_rim(p) < 0.3) {
        ASSERT_NEAR(gap, to_rim(p), 0.06 * to_rim(p)) << p.transpose() << " seed " << seed;
      } else if (std::abs(p.x() - 3.0) < 1e-9 && std::abs(p.y()) < 0.5) {
        const double expected = (p - hole_centre).norm() - 1.0;
        ASSERT_NEAR(gap, expected, 0.06 * expected) << p.transpose() << " seed " << seed;
      }
      // The hole does not see itself: the surface is not inside it.
      ASSERT_GE(gap, 0.95 * ligament);
    }
    EXPECT_NEAR(least, ligament, 0.003) << "seed " << seed;
  }
}

TEST(ProximityStartSizes, CurvesThatMeetAtASharpAngleInASurface) {
  const double sine = std::sin(10.0 * test::pi / 180.0);
  const double slope = std::tan(10.0 * test::pi / 180.0);
  FacetedSource surface;
  surface.entity = {2, 1};
  surface.triangles.push_back({Vec3(0, 0, 0), Vec3(10, 0, 0), Vec3(10, 10 * slope, 0)});
  const Sources curves = {test::curve_of(1, {{0, 0, 0}, {10, 0, 0}}, false),
                          test::curve_of(2, {{10, 0, 0}, {10, 10 * slope, 0}}, false),
                          test::curve_of(3, {{0, 0, 0}, {10, 10 * slope, 0}}, false)};
  const SizedFacets facets =
      gaps_of(surface_walls(surface, curves, {}), {{1, 1}, {1, 2}, {1, 3}}, parameters_of(2.0));
  ASSERT_FALSE(facets.empty());
  for (const SizedFacet& facet : facets) {
    const double x = facet.facet.centroid().norm();
    ASSERT_GT(x, 1.8);
    ASSERT_NEAR(facet.start_size, x * sine, 0.05 * x * sine) << "x = " << x;
  }
}

TEST(ProximityStartSizes, ACurveBetweenTwoOthersHidesThem) {
  // A strip of height 1, with a curve embedded along its middle for x < 5.
  const FacetedSource surface =
      test::patch(1, 10, 2, [](int i, int j) { return Vec3(i, 0.5 * j, 0); });
  const Sources curves = {
      test::curve_of(1,
                     {{0, 0, 0},
                      {1, 0, 0},
                      {2, 0, 0},
                      {3, 0, 0},
                      {4, 0, 0},
                      {5, 0, 0},
                      {6, 0, 0},
                      {7, 0, 0},
                      {8, 0, 0},
                      {9, 0, 0},
                      {10, 0, 0}},
                     false),
      test::curve_of(2,
                     {{0, 1, 0},
                      {1, 1, 0},
                      {2, 1, 0},
                      {3, 1, 0},
                      {4, 1, 0},
                      {5, 1, 0},
                      {6, 1, 0},
                      {7, 1, 0},
                      {8, 1, 0},
                      {9, 1, 0},
                      {10, 1, 0}},
                     false),
      test::curve_of(3,
                     {{0, 0.5, 0}, {1, 0.5, 0}, {2, 0.5, 0}, {3, 0.5, 0}, {4, 0.5, 0}, {5, 0.5, 0}},
                     false)};
  const std::vector<Wall> walls = surface_walls(surface, curves, {});
  const SizedFacets facets = gaps_of(walls, {{1, 1}}, parameters_of(20.0));
  expect_gaps(chosen(facets, [](const Vec3& p) { return p.x() < 5.0; }), 0.499, 0.5001);
  expect_gaps(chosen(facets, [](const Vec3& p) { return p.x() > 5.6; }), 0.94, 1.01);
  EXPECT_NEAR(measure(facets), 10.0, 1e-9);
  // The embedded one looks both ways.
  const SizedFacets embedded = gaps_of(walls, {{1, 3}}, parameters_of(20.0));
  EXPECT_EQ(embedded.size(), 10u);
  expect_gaps(embedded, 0.499999, 0.500001);
}

// ==== What makes no gap

TEST(ProximityStartSizes, ThinWallMakesNoGapWithItself) {
  const Sources faces = joined(test::box_faces({0, 0, 0}, {10, 10, 10}, 4),
                               test::box_faces({4.9, 2, 2}, {5.1, 8, 8}, 3, 11));
  expect_gaps(gaps_in(faces, parameters_of(10.0)), 1.9, 10.01);
  const SizedFacets wall = gaps_of(volume_walls(faces), {{2, 11}}, parameters_of(10.0));
  expect_gaps(wall, 4.85, 4.95);
  EXPECT_NEAR(measure(wall), 36.0, 1e-9);
}

TEST(ProximityStartSizes, TwoBoxesSideBySideSeenFromOutside) {
  const Sources faces = joined(joined(test::box_faces({-5, -5, -5}, {8, 6, 6}, 3),
                                      test::box_faces({0, 0, 0}, {1, 1, 1}, 2, 11)),
                               test::box_faces({1.3, 0, 0}, {2.3, 1, 1}, 3, 21));
  const SizedFacets facets = gaps_in(faces, parameters_of(0.8));
  const SizedFacets between = chosen(facets, [](const Vec3& p) {
    return std::abs(p.x() - 1.0) < 1e-9 || std::abs(p.x() - 1.3) < 1e-9;
  });
  EXPECT_NEAR(measure(between), 2.0, 1e-9);
  expect_gaps(between, 0.299999, 0.300001);
  EXPECT_EQ(facets.size(), between.size());  // all others are further than 1 or do not oppose
}

TEST(ProximityStartSizes, RightAnglesDoNotOppose) {
  // Legs of width 3 and length 9.
  const test::Outline outline = {{0, 0, 0}, {9, 0, 0}, {9, 3, 0}, {3, 3, 0}, {3, 9, 0}, {0, 9, 0}};
  Sources faces;
  for (int side = 0; side < 6; ++side) {
    const Vec3 a = outline[side];
    const Vec3 b = outline[(side + 1) % 6];
    faces.push_back(test::patch(3 + side, 4, 4, [&](int i, int j) {
      Vec3 p = i == 0 ? a : i == 4 ? b : Vec3(a + 0.25 * i * (b - a));
      p.z() = 25.0 * j;
      return p;
    }));
  }
  for (const double z : {0.0, 100.0}) {
    FacetedSource cap;
    cap.entity = {2, z == 0.0 ? 1 : 2};
    const auto square = [&](double x, double y) {
      const auto p = [&](double s, double t) { return Vec3(x + s, y + t, z); };
      cap.quads.push_back({p(0, 0), p(3, 0), p(3, 3), p(0, 3)});
    };
    square(0, 0);
    square(3, 0);
    square(6, 0);
    square(0, 3);
    square(0, 6);
    faces.push_back(cap);
  }
  const SizedFacets closed = gaps_in(faces, parameters_of(4.0));
  ASSERT_FALSE(closed.empty());
  expect_gaps(closed, 2.99, 9.01);
}

TEST(ProximityStartSizes, EmbeddedWallLooksBothWays) {
  Sources faces = test::box_faces({0, 0, 0}, {10, 10, 3}, 4);
  faces.push_back(test::patch(20, 5, 5, [](int i, int j) { return Vec3(2.5 + i, 2.5 + j, 1.0); }));
  const std::vector<Wall> walls = volume_walls(faces);
  const SizedFacets facets = gaps_of(walls, {{2, 20}}, parameters_of(10.0));
  EXPECT_EQ(facets.size(), 100u);
  EXPECT_EQ(std::count_if(facets.begin(), facets.end(),
                          [](const SizedFacet& f) { return std::abs(f.start_size - 1.0) < 1e-6; }),
            50);
  EXPECT_EQ(std::count_if(facets.begin(), facets.end(),
                          [](const SizedFacet& f) { return std::abs(f.start_size - 2.0) < 1e-6; }),
            50);
  // Floor and ceiling see it, and each other only beside it.
  const SizedFacets floor = gaps_of(walls, {{2, 5}}, parameters_of(10.0));
  const auto inside = [](const Vec3& p) { return Box(Vec3(3, 3, -1), Vec3(7, 7, 1)).contains(p); };
  expect_gaps(chosen(floor, inside), 0.95, 1.001);
  EXPECT_FALSE(chosen(floor, inside).empty());
}

TEST(ProximityStartSizes, BentEmbeddedWallMakesNoGapWithItself) {
  Sources faces = test::box_faces({-5, -5, -5}, {5, 5, 5}, 4);
  faces.push_back(test::patch(20, 24, 3, [](int i, int j) {
    return Vec3(0.25 * i - 3.0, 0.5 * j, 0.1 * std::sin(0.25 * i * 2.0));
  }));
  const SizedFacets facets = gaps_of(volume_walls(faces), {{2, 20}}, parameters_of(10.0));
  EXPECT_GE(facets.size(), 288u);
  expect_gaps(facets, 4.5, 5.5);
}

// ==== Independence

Sources busy_model() {
  return joined(joined(test::box_faces({-3, -3, -3}, {3, 3, 3}, 6),
                       {test::sphere_face(11, {0.5, 0.2, 0.1}, 1.2, 3)}),
                test::box_faces({-2, -2, -2.8}, {2, 2, -1.5}, 4, 21));
}

TEST(ProximityStartSizes, DoNotDependOnTheNumberOfThreads) {
  const Sources faces = busy_model();
  const std::vector<Wall> walls = volume_walls(faces);
  SizedFacets expected;
  for (const int threads : {1, 2, 3, 7}) {
    ProximityParameters parameters = parameters_of(3.0);
    parameters.threads = threads;
    SizedFacets facets;
    append_proximity_start_sizes(walls, test::entities_of(faces), parameters, facets);
    if (threads == 1) {
      expected = facets;
      EXPECT_GT(facets.size(), 500u);
    }
    EXPECT_TRUE(facets == expected) << threads;
  }
}

TEST(ProximityStartSizes, DoNotDependOnTheOrientationOfFacets) {
  constexpr unsigned seed = 51;
  Random random(seed);
  const SizedFacets expected = gaps_in(busy_model(), parameters_of(3.0));
  for (int round = 0; round < 3; ++round) {
    const SizedFacets facets =
        gaps_in(test::with_mixed_orientation(busy_model(), random), parameters_of(3.0));
    EXPECT_NEAR(measure(facets), measure(expected), 1e-3 * measure(expected)) << "seed " << seed;
    const FacetTree tree(facets);
    const FacetTree expected_tree(expected);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = test::random_in_box(random, test::cube(3.0));
      const double size = expected_tree.size(p);
      ASSERT_NEAR(tree.size(p), size, 0.03 * size) << "seed " << seed;
    }
  }
}

TEST(ProximityStartSizes, AreAppended) {
  SizedFacets facets{{Facet::point({0, 0, 0}), 1.0, 0.5}};
  const Sources faces = test::box_faces({0, 0, 0}, {10, 10, 1});
  append_proximity_start_sizes(volume_walls(faces), {{2, 5}}, parameters_of(20.0), facets);
  EXPECT_EQ(facets.size(), 3u);
  EXPECT_EQ(facets[0].start_size, 1.0);
}

// ==== Beside brute force

std::vector<Wall> random_walls(Random& random, std::size_t count, int corner_count) {
  std::vector<Wall> walls;
  while (walls.size() < count) {
    Vec3 a = test::random_in_ball(random, 1.0);
    Vec3 b = a + test::uniform(random, 0.02, 0.3) * test::random_direction(random);
    const Vec3 c = a + test::uniform(random, 0.02, 0.3) * test::random_direction(random);
    if (corner_count == 3) {
      const Vec3 normal = (b - a).cross(c - a).normalized();
      walls.push_back({Facet::triangle(a, b, c), normal, {2, 1}});
    } else {
      a.z() = b.z() = 0.0;
      const Vec3 normal = Vec3(a.y() - b.y(), b.x() - a.x(), 0.0).normalized();
      walls.push_back({Facet::segment(a, b), normal, {1, 1}});
    }
  }
  return walls;
}

bool faces_each_other(const Wall& a, const Wall& b) {
  return a.inward.dot(b.inward) <= -std::sqrt(0.5);
}

bool blocked(const std::vector<Wall>& walls, const Vec3& p, const Vec3& q) {
  const Vec3 way = (q - p).normalized();
  const double length = (q - p).norm();
  return std::any_of(walls.begin(), walls.end(), [&](const Wall& wall) {
    if (wall.facet.corner_count == 3) {
      const double hit = ray_distance(wall.facet, p, way);
      return wall.inward.dot(way) < 0.0 && hit > 1e-7 && hit < length - 1e-6;
    }
    // In the plane: the ends of each on different sides of the other.
    const Vec3 a = wall.facet.corners[0] - p;
    const Vec3 b = wall.facet.corners[1] - p;
    const Vec3 across(-way.y(), way.x(), 0.0);
    if ((a.dot(across) < 0.0) == (b.dot(across) < 0.0)) {
      return false;
    }
    const double t = a.dot(across) / (a - b).dot(across);
    const double hit = (a + t * (b - a)).dot(way);
    return hit > 1e-6 && hit < length - 1e-5;
  });
}

/// The definition, literally. Random walls share no corners, so none touch.
double brute_force_gap(const std::vector<Wall>& walls, std::size_t from, const Vec3& p) {
  const Wall& own = walls[from];
  double gap = infinity;
  double first = infinity;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const double hit = ray_distance(walls[i].facet, p, own.inward);
    if (i != from && hit < first && walls[i].inward.dot(own.inward) < 0.0) {
      first = hit;
      gap = faces_each_other(own, walls[i]) ? hit : infinity;
    }
  }
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Vec3 q = closest_point(walls[i].facet, p);
    const Vec3 way = q - p;
    if (faces_each_other(own, walls[i]) && way.dot(own.inward) >= std::sqrt(0.5) * way.norm() &&
        way.dot(walls[i].inward) <= -GapFinder::cosine_of_square * way.norm() &&
        !blocked(walls, p, q)) {
      gap = std::min(gap, way.norm());
    }
  }
  return gap;
}

TEST(GapFinder, GapsEqualBruteForce) {
  for (const int corner_count : {2, 3}) {
    for (const unsigned seed : {61u, 62u, 63u}) {
      Random random(seed);
      const std::vector<Wall> walls = random_walls(random, seed == 61 ? 60 : 400, corner_count);
      const GapFinder finder(walls, 0.1);
      int finite = 0;
      for (int round = 0; round < 1500; ++round) {
        const std::size_t from = test::random_index(random, walls.size());
        const Vec3 p = test::random_on_facet(random, walls[from].facet);
        const double expected = brute_force_gap(walls, from, p);
        const double gap = finder.gap(from, p, infinity);
        if (expected == infinity) {
          ASSERT_EQ(gap, infinity) << "seed " << seed << " round " << round;
          continue;
        }
        ++finite;
        ASSERT_GE(gap, expected * (1.0 - 1e-6)) << "seed " << seed << " round " << round;
        ASSERT_LE(gap, expected / 0.99 * (1.0 + 1e-6)) << "seed " << seed << " round " << round;
        ASSERT_EQ(finder.gap(from, p, 0.98 * gap), infinity);
      }
      EXPECT_GT(finite, 100) << "seed " << seed;
    }
  }
}

TEST(GapFinder, BoundsOverPiecesHold) {
  for (const int corner_count : {2, 3}) {
    for (const unsigned seed : {71u, 72u}) {
      Random random(seed);
      const std::vector<Wall> walls = random_walls(random, 200, corner_count);
      const GapFinder finder(walls, 0.1);
      int clear = 0;
      int unfaced = 0;
      for (int round = 0; round < 3000; ++round) {
        const std::size_t wall = test::random_index(random, walls.size());
        const Facet& piece = walls[wall].facet;
        const Vec3 centre = piece.centroid();
        double radius = 0.0;
        for (const Vec3& corner : piece.corners) {
          radius = std::max(radius, (corner - centre).norm());
        }
        const double width = test::log_uniform(random, 0.01, 1.0);
        const bool is_clear = finder.is_clear(piece, wall, width);
        const bool is_faced = finder.is_faced(piece, wall, width);
        clear += is_clear ? 1 : 0;
        unfaced += is_faced ? 0 : 1;
        for (int sample = 0; sample < 5; ++sample) {
          const Vec3 p = test::random_on_facet(random, piece);
          const double gap = finder.gap(wall, p, infinity);
          ASSERT_TRUE(!is_clear || gap >= width * (1.0 - 1e-9)) << "seed " << seed;
          ASSERT_TRUE(is_faced || gap >= width - radius - 1e-9) << "seed " << seed;
        }
      }
      EXPECT_GT(clear, 100);
      EXPECT_GT(unfaced, 100);
    }
  }
}

}  // namespace
}  // namespace meshgrow
