#include "attached_region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "background_grid.h"
#include "brute_force.h"
#include "graded_sphere.h"
#include "growth_law.h"
#include "random_facets.h"
#include "start_sizes/mesh_start_sizes.h"

namespace meshgrow {
namespace {

using test::Random;
using Triangles = std::vector<std::array<Vec3, 3>>;

/// Between two spheres about the origin.
Triangles shell(double inner, double outer) {
  Triangles triangles;
  for (const double radius : {inner, outer}) {
    for (const auto& [a, b, c] : test::graded_sphere(3000, 4.0)) {
      triangles.push_back({radius * a, radius * b, radius * c});
    }
  }
  return triangles;
}

TEST(AttachedRegion, TellsInsideFromOutside) {
  const AttachedRegion region(shell(0.5, 1.0));
  constexpr unsigned seed = 1;
  Random random(seed);
  // The spheres are polyhedra: within 0.02 of the round ones.
  const auto from_round = [](const Vec3& p) {
    return std::min(std::abs(p.norm() - 0.5), std::abs(p.norm() - 1.0));
  };
  const auto is_inside = [](const Vec3& p) { return p.norm() > 0.5 && p.norm() < 1.0; };
  int enclosed = 0;
  int separated = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = test::random_in_box(random, test::cube(1.3));
    const Vec3 q = test::random_in_box(random, test::cube(1.3));
    const double radius = test::log_uniform(random, 1e-3, 0.3);
    if (from_round(p) < radius - 0.02) {
      ASSERT_TRUE(region.touches(p, radius)) << "seed " << seed << " at " << p.transpose();
    } else if (from_round(p) > radius + 0.03) {
      ASSERT_FALSE(region.touches(p, radius)) << "seed " << seed << " at " << p.transpose();
    }
    if (from_round(p) > 0.02 && from_round(q) > 0.02) {
      ASSERT_EQ(region.encloses(p), is_inside(p)) << "seed " << seed << " at " << p.transpose();
      ASSERT_EQ(region.separates(p, q), is_inside(p) != is_inside(q))
          << "seed " << seed << " from " << p.transpose() << " to " << q.transpose();
      enclosed += is_inside(p) ? 1 : 0;
      separated += is_inside(p) != is_inside(q) ? 1 : 0;
    }
  }
  EXPECT_GT(enclosed, 500);
  EXPECT_GT(separated, 500);
  EXPECT_FALSE(region.separates(Vec3(1, 1, 1), Vec3(1, 1, 1)));
}

TEST(AttachedRegion, NeighboursAreOneRegion) {
  // Two cubes with a common face, which is given with each of them.
  Triangles triangles;
  for (const double x : {0.0, 1.0}) {
    const auto quad = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
      const Vec3 shift(x, 0, 0);
      triangles.push_back({a + shift, b + shift, c + shift});
      triangles.push_back({a + shift, c + shift, d + shift});
    };
    for (const double side : {0.0, 1.0}) {
      quad({side, 0, 0}, {side, 1, 0}, {side, 1, 1}, {side, 0, 1});
      quad({0, side, 0}, {1, side, 0}, {1, side, 1}, {0, side, 1});
      quad({0, 0, side}, {1, 0, side}, {1, 1, side}, {0, 1, side});
    }
  }
  const AttachedRegion region(triangles);
  EXPECT_TRUE(region.encloses({0.45, 0.55, 0.5}));
  EXPECT_TRUE(region.encloses({1.45, 0.55, 0.5}));
  EXPECT_FALSE(region.separates({0.45, 0.55, 0.5}, {1.45, 0.52, 0.51}));
  EXPECT_FALSE(region.encloses({2.45, 0.55, 0.5}));
  EXPECT_FALSE(region.encloses({-0.45, 0.55, 0.5}));
  EXPECT_TRUE(region.separates({0.45, 0.55, 0.5}, {-0.45, 0.52, 0.51}));
}

TEST(AttachedRegion, GridsAreNotRefinedOutsideAndAnswerAsBefore) {
  FacetedSource source;
  source.triangles = test::graded_sphere(4000, 10.0);
  SizedFacets facets;
  append_mesh_start_sizes(source, QuadSize::triangles, growth_slope(1.2), facets);
  const auto tree = std::make_shared<const FacetTree>(facets);
  // The volume is what is between the source and a sphere around it.
  Triangles boundary = source.triangles;
  for (const auto& [a, b, c] : source.triangles) {
    boundary.push_back({1.4 * a, 1.4 * b, 1.4 * c});
  }
  GridOptions options;
  options.facets_per_exact_leaf = 48;
  options.threads = 1;
  const BackgroundGrid whole(tree, 2.0, test::cube(1.4), options);
  options.region = std::make_shared<const AttachedRegion>(boundary);
  const BackgroundGrid spared(tree, 2.0, test::cube(1.4), options);
  const auto cells = [](const BackgroundGrid& grid) {
    return grid.statistics().interpolated_leaves + grid.statistics().exact_leaves;
  };
  EXPECT_LT(cells(spared), 0.8 * cells(whole));
  constexpr unsigned seed = 2;
  Random random(seed);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = test::random_in_box(random, test::cube(1.4));
    if (p.norm() > 1.0 && p.norm() < 1.35) {
      ASSERT_EQ(spared.size(p), whole.size(p)) << "seed " << seed << " at " << p.transpose();
    } else {
      const double exact = tree->size(p, 2.0);
      ASSERT_LE(spared.size(p), 1.05 * exact) << "seed " << seed << " at " << p.transpose();
      ASSERT_GE(spared.size(p), 0.85 * exact) << "seed " << seed << " at " << p.transpose();
    }
  }
}

}  // namespace
}  // namespace meshgrow
