#include "region_walls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "random_facets.h"
#include "wall_shapes.h"

namespace meshgrow {
namespace {

using test::Random;
using test::Sources;

std::size_t triangle_count(const Sources& faces) {
  std::size_t count = 0;
  for (const FacetedSource& face : faces) {
    count += face.triangles.size() + 2 * face.quads.size();
  }
  return count;
}

/// Every wall looks to where a point just above it is inside.
void expect_walls_look_inside(const std::vector<Wall>& walls,
                              const std::function<bool(const Vec3&)>& is_inside,
                              double off = 1e-4) {
  for (const Wall& wall : walls) {
    const Vec3 p = wall.facet.centroid() + off * wall.inward;
    ASSERT_NEAR(wall.inward.norm(), 1.0, 1e-12);
    ASSERT_TRUE(is_inside(p)) << entity_name(wall.entity) << " at " << p.transpose();
  }
}

std::size_t walls_of(const std::vector<Wall>& walls, int tag) {
  return std::count_if(walls.begin(), walls.end(),
                       [tag](const Wall& wall) { return wall.entity.tag == tag; });
}

bool in_box(const Vec3& p, const Vec3& low, const Vec3& high) { return Box(low, high).contains(p); }

// ==== Volumes

TEST(VolumeWalls, NothingFromNothing) {
  EXPECT_TRUE(volume_walls({}).empty());
  EXPECT_TRUE(volume_walls({FacetedSource{}}).empty());
}

TEST(VolumeWalls, BoxLooksInside) {
  for (const int n : {1, 4}) {
    const Sources faces = test::box_faces({-1, -2, 0}, {1, 2, 0.5}, n);
    const std::vector<Wall> walls = volume_walls(faces);
    EXPECT_EQ(walls.size(), triangle_count(faces));
    expect_walls_look_inside(walls, [](const Vec3& p) {
      return in_box(p, {-1, -2, 0}, {1, 2, 0.5});
    });
  }
}

TEST(VolumeWalls, QuadsGiveTwoTrianglesEach) {
  Sources faces = test::box_faces({0, 0, 0}, {1, 1, 1}, 3);
  for (FacetedSource& face : faces) {
    for (std::size_t i = 0; i < face.triangles.size(); i += 2) {
      face.quads.push_back({face.triangles[i][0], face.triangles[i][1], face.triangles[i][2],
                            face.triangles[i + 1][2]});
    }
    face.triangles.clear();
  }
  const std::vector<Wall> walls = volume_walls(faces);
  EXPECT_EQ(walls.size(), 6u * 9u * 2u);
  expect_walls_look_inside(walls, [](const Vec3& p) { return in_box(p, {0, 0, 0}, {1, 1, 1}); });
}

TEST(VolumeWalls, OrientationOfFacetsDoesNotMatter) {
  constexpr unsigned seed = 11;
  Random random(seed);
  const Sources faces =
      test::with_mixed_orientation(test::joined({test::sphere_face(7, {0, 0, 0}, 2.0, 3)},
                                                test::box_faces({-3, -3, -3}, {3, 3, 3}, 3)),
                                   random);
  const std::vector<Wall> walls = volume_walls(faces);
  EXPECT_EQ(walls.size(), triangle_count(faces)) << "seed " << seed;
  expect_walls_look_inside(walls, [](const Vec3& p) {
    return in_box(p, {-3, -3, -3}, {3, 3, 3}) && p.norm() > 1.97;
  });
}

TEST(VolumeWalls, TurnedMovedAndScaledSolids) {
  constexpr unsigned seed = 12;
  Random random(seed);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (int round = 0; round < 50; ++round) {
      const Eigen::AngleAxisd turn(test::uniform(random, 0.0, 3.0), test::random_direction(random));
      const Vec3 offset = 100.0 * scale * test::random_in_ball(random, 1.0);
      const auto there = [&](const Vec3& p) { return Vec3(scale * (turn * p) + offset); };
      const auto back = [&](const Vec3& p) {
        return Vec3(turn.inverse() * ((p - offset) / scale));
      };
      const Sources faces =
          test::moved(test::joined(test::box_faces({0, 0, 0}, {4, 5, 1}),
                                   test::box_faces({1, 1, 0.25}, {2, 2, 0.5}, 2, 10)),
                      there);
      const std::vector<Wall> walls = volume_walls(faces);
      ASSERT_EQ(walls.size(), triangle_count(faces)) << "seed " << seed << " round " << round;
      expect_walls_look_inside(
          walls,
          [&](const Vec3& p) {
            return in_box(back(p), {0, 0, 0}, {4, 5, 1}) &&
                   !in_box(back(p), {1, 1, 0.25}, {2, 2, 0.5});
          },
          1e-4 * scale);
    }
  }
}

TEST(VolumeWalls, ShellBetweenSpheresInOneFace) {
  // Both spheres of the same entity: sides are told for each by itself.
  FacetedSource face = test::sphere_face(1, {0, 0, 0}, 1.0, 3);
  const FacetedSource inner = test::sphere_face(1, {0.2, 0, 0}, 0.5, 2);
  face.triangles.insert(face.triangles.end(), inner.triangles.begin(), inner.triangles.end());
  const std::vector<Wall> walls = volume_walls({face});
  EXPECT_EQ(walls.size(), face.triangles.size());
  expect_walls_look_inside(
      walls, [](const Vec3& p) { return p.norm() < 1.0 && (p - Vec3(0.2, 0, 0)).norm() > 0.48; });
}

/// A square at height z, which does not reach the walls of the box from 0 to 1.
FacetedSource embedded(int tag, double z) {
  return test::patch(tag, 2, 2,
                     [z](int i, int j) { return Vec3(0.25 + 0.25 * i, 0.25 + 0.25 * j, z); });
}

TEST(VolumeWalls, EmbeddedFacesHaveTheVolumeOnBothSides) {
  Sources faces = test::box_faces({0, 0, 0}, {1, 1, 1}, 2);
  faces.push_back(embedded(20, 0.25));
  faces.push_back(embedded(21, 0.5));
  faces.push_back(embedded(22, 0.75));
  const std::vector<Wall> walls = volume_walls(faces);
  EXPECT_EQ(walls.size(), 6u * 8u + 3u * 16u);
  for (const int tag : {20, 21, 22}) {
    EXPECT_EQ(walls_of(walls, tag), 16u);
  }
  expect_walls_look_inside(walls, [](const Vec3& p) { return in_box(p, {0, 0, 0}, {1, 1, 1}); });
}

TEST(VolumeWalls, EmbeddedFaceThatHangsOnTheBoundary) {
  // It shares sides with the floor of the box.
  Sources faces = test::box_faces({0, 0, 0}, {1, 1, 1}, 4);
  faces.push_back(
      test::patch(20, 2, 2, [](int i, int j) { return Vec3(0.25 + 0.25 * i, 0.5, 0.25 * j); }));
  const std::vector<Wall> walls = volume_walls(faces);
  EXPECT_EQ(walls_of(walls, 20), 16u);
  EXPECT_EQ(walls.size(), 6u * 32u + 16u);
  expect_walls_look_inside(walls, [](const Vec3& p) { return in_box(p, {0, 0, 0}, {1, 1, 1}); });
}

TEST(VolumeWalls, SlitOfTwoFacesInTheSamePlace) {
  Sources faces = test::box_faces({0, 0, 0}, {1, 1, 1}, 2);
  faces.push_back(embedded(20, 0.5));
  faces.push_back(embedded(21, 0.5));
  const std::vector<Wall> walls = volume_walls(faces);
  EXPECT_EQ(walls.size(), 6u * 8u + 2u * 16u);
}

TEST(VolumeWalls, MoebiusStripIsVotedFacetByFacet) {
  constexpr int n = 24;
  const FacetedSource strip = test::patch(20, n, 2, [](int i, int j) {
    const bool around = i == n;
    const double angle = around ? 0.0 : 2.0 * test::pi * i / n;
    const double across = 0.1 * (around ? 1 - j : j - 1);
    const Vec3 radial(std::cos(angle), std::sin(angle), 0.0);
    return Vec3(0.5 * radial +
                across * (std::cos(0.5 * angle) * radial + std::sin(0.5 * angle) * Vec3(0, 0, 1)));
  });
  Sources faces = test::box_faces({-1, -1, -1}, {1, 1, 1});
  faces.push_back(strip);
  const std::vector<Wall> walls = volume_walls(faces);
  EXPECT_EQ(walls_of(walls, 20), 2 * strip.triangles.size());
  EXPECT_EQ(walls.size(), 12 + 2 * strip.triangles.size());
}

TEST(VolumeWalls, SeveralFacesThatAreNoBoundaryOfTheVolumeGiveNone) {
  // Alone in space, an open face encloses nothing.
  EXPECT_TRUE(volume_walls({embedded(20, 0.5)}).empty());
}

TEST(VolumeWalls, SmallLeaksDoNotMatter) {
  // The facets of two faces do not fit together where they meet: one is finer.
  Sources faces = test::box_faces({0, 0, 0}, {1, 1, 1}, 2);
  faces[5] = test::box_faces({0, 0, 0}, {1, 1, 1}, 3)[5];
  faces[0].triangles.pop_back();
  const std::vector<Wall> walls = volume_walls(faces);
  EXPECT_EQ(walls.size(), triangle_count(faces));
  expect_walls_look_inside(walls, [](const Vec3& p) { return in_box(p, {0, 0, 0}, {1, 1, 1}); });
}

TEST(VolumeWalls, FacetsWithoutAreaAreLeftOut) {
  Sources faces = test::box_faces({0, 0, 0}, {1, 1, 1}, 2);
  const Vec3 nan = Vec3::Constant(std::nan(""));
  faces[0].triangles.push_back({Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 1, 0)});
  faces[0].triangles.push_back({Vec3(0, 0, 0), Vec3(0, 0.5, 0), Vec3(0, 1, 0)});
  faces[0].triangles.push_back({nan, Vec3(0, 0.5, 0), Vec3(0, 1, 0)});
  const std::vector<Wall> walls = volume_walls(faces);
  EXPECT_EQ(walls.size(), 6u * 8u);
  expect_walls_look_inside(walls, [](const Vec3& p) { return in_box(p, {0, 0, 0}, {1, 1, 1}); });
}

TEST(VolumeWalls, CollapsedQuadsHoldTheirNeighboursTogether) {
  // A sphere by rows of quads, those at its poles with two equal corners.
  FacetedSource face;
  face.entity = {2, 1};
  constexpr int rows = 6;
  constexpr int columns = 8;
  const auto at = [](int i, int j) {
    const double height = test::pi * i / rows;
    const double angle = 2.0 * test::pi * (j % columns) / columns;
    const double r = i == 0 || i == rows ? 0.0 : std::sin(height);
    return Vec3(r * std::cos(angle), r * std::sin(angle), std::cos(height));
  };
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      face.quads.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  const std::vector<Wall> walls = volume_walls({face});
  EXPECT_EQ(walls.size(), static_cast<std::size_t>(2 * columns * (rows - 1)));
  expect_walls_look_inside(walls, [](const Vec3& p) { return p.norm() < 1.0; });
}

// ==== Surfaces

/// The square from 0 to 1 in 2 × 2 cells, turned by the map.
FacetedSource square(const std::function<Vec3(const Vec3&)>& map) {
  return test::patch(1, 2, 2, [&](int i, int j) { return map(Vec3(0.5 * i, 0.5 * j, 0.0)); });
}

FacetedSource curve(int tag, const std::vector<Vec3>& points) {
  return test::curve_of(tag, points, false);
}

TEST(SurfaceWalls, LookIntoTheSurface) {
  constexpr unsigned seed = 21;
  Random random(seed);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const Eigen::AngleAxisd turn(test::uniform(random, 0.0, 3.0), test::random_direction(random));
    const auto map = [&](const Vec3& p) { return Vec3(scale * (turn * p)); };
    const std::vector<Wall> walls =
        surface_walls(square(map),
                      {curve(5, {map({0, 0, 0}), map({0.5, 0, 0}), map({1, 0, 0})}),
                       curve(6, {map({1, 0.5, 0}), map({1, 0, 0})}),
                       curve(7, {map({0.5, 0, 0}), map({0.5, 0.5, 0})})},
                      {});
    ASSERT_EQ(walls.size(), 5u) << "seed " << seed;
    const auto expect = [&](const Wall& wall, const Entity& entity, const Vec3& inward) {
      EXPECT_EQ(wall.entity, entity);
      EXPECT_EQ(wall.facet.corner_count, 2);
      EXPECT_LT((turn.inverse() * wall.inward - inward).norm(), 1e-12) << "seed " << seed;
    };
    expect(walls[0], {1, 5}, {0, 1, 0});
    expect(walls[1], {1, 5}, {0, 1, 0});
    expect(walls[2], {1, 6}, {-1, 0, 0});
    // Embedded: one wall for each side.
    expect(walls[3], {1, 7},
           walls[3].inward.dot(turn * Vec3(1, 0, 0)) > 0 ? Vec3(1, 0, 0) : Vec3(-1, 0, 0));
    EXPECT_LT((walls[3].inward + walls[4].inward).norm(), 1e-12);
  }
}

TEST(SurfaceWalls, SeamsStrangersAndRepeatedSegmentsGiveNone) {
  const auto same = [](const Vec3& p) { return p; };
  const FacetedSource seam = curve(5, {{0, 0, 0}, {0, 0.5, 0}});
  EXPECT_EQ(surface_walls(square(same), {seam}, {{1, 5}}).size(), 0u);
  EXPECT_EQ(surface_walls(square(same), {seam, seam}, {}).size(), 1u);
  EXPECT_EQ(surface_walls(square(same), {curve(6, {{0, 0, 0}, {0, 0.4, 0}})}, {}).size(), 0u);
  EXPECT_EQ(surface_walls(square(same), {curve(6, {{0, 0, 0}, {0, 0, 0}})}, {}).size(), 0u);
  EXPECT_EQ(surface_walls(square(same), {}, {}).size(), 0u);
  EXPECT_EQ(surface_walls({}, {seam}, {}).size(), 0u);
}

TEST(SurfaceWalls, QuadsHaveTheirSides) {
  FacetedSource surface;
  surface.entity = {2, 1};
  surface.quads.push_back({Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 1, 0), Vec3(0, 1, 0)});
  const std::vector<Wall> walls = surface_walls(
      surface, {curve(5, {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {0, 0, 0}})}, {});
  ASSERT_EQ(walls.size(), 4u);
  EXPECT_LT((walls[0].inward - Vec3(0, 1, 0)).norm(), 1e-12);
  EXPECT_LT((walls[3].inward - Vec3(1, 0, 0)).norm(), 1e-12);
}

TEST(SurfaceWalls, OfACurvedSurfaceLieInIt) {
  // A cylinder: the walls at its rims look along its axis.
  const FacetedSource mantle = test::mantle_face(1, test::circle({0, 0, 0}, 1.0, 16), 2.0, 4);
  const std::vector<Wall> walls =
      surface_walls(mantle, {test::curve_of(5, test::circle({0, 0, 0}, 1.0, 16))}, {});
  ASSERT_EQ(walls.size(), 16u);
  for (const Wall& wall : walls) {
    EXPECT_LT((wall.inward - Vec3(0, 0, 1)).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace meshgrow
