#include "background_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "brute_force.h"
#include "error.h"
#include "graded_sphere.h"
#include "growth_law.h"
#include "random_facets.h"
#include "start_sizes/mesh_start_sizes.h"

namespace meshgrow {
namespace {

using test::Random;
using test::RandomFacets;

/// A size field to build a grid of.
struct Case {
  std::string name;
  SizedFacets facets;
  double size_limit = 2.0;
  Box box = test::cube(1.5);
};

// ==== Cases

SizedFacets mesh_facets(FacetedSource source, double growth_rate) {
  SizedFacets facets;
  append_mesh_start_sizes(source, QuadSize::triangles, growth_slope(growth_rate), facets);
  return facets;
}

Case sphere(std::size_t facet_count, double growth_rate = 1.2) {
  FacetedSource source;
  source.triangles = test::graded_sphere(facet_count, 20.0);
  return {"sphere", mesh_facets(source, growth_rate)};
}

Case mixed(std::size_t facet_count, double smallest_size, unsigned seed) {
  Random random(seed);
  RandomFacets wanted;
  wanted.count = facet_count;
  wanted.smallest_size = smallest_size;
  wanted.largest_size = 0.5;
  return {"mixed", test::random_facets(random, wanted), 1.0};
}

Case degenerate(std::size_t facet_count, unsigned seed) {
  Random random(seed);
  RandomFacets wanted;
  wanted.count = facet_count;
  wanted.mix = test::FacetMix::degenerate;
  wanted.smallest_size = 1e-3;
  return {"degenerate", test::random_facets(random, wanted), 1.0};
}

/// A box of no thickness: upper and lower face coincide, and so do their facets.
Case plate(int n) {
  FacetedSource source;
  for (int side = 0; side < 2; ++side) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const auto node = [&](int di, int dj) {
          return Vec3(2.0 * (i + di) / n - 1.0, 2.0 * (j + dj) / n - 1.0, 0.1);
        };
        if (side == 0) {
          source.triangles.push_back({node(0, 0), node(1, 0), node(1, 1)});
          source.triangles.push_back({node(0, 0), node(1, 1), node(0, 1)});
        } else {
          source.triangles.push_back({node(0, 0), node(1, 0), node(0, 1)});
          source.triangles.push_back({node(1, 0), node(1, 1), node(0, 1)});
        }
      }
    }
  }
  return {"plate", mesh_facets(source, 1.2)};
}

/// Two squares that face each other at a small distance: between them is a ridge of the field.
Case facing_plates() {
  Case result = plate(12);
  result.name = "facing_plates";
  const std::size_t half = result.facets.size() / 2;
  for (std::size_t i = 0; i < half; ++i) {
    for (Vec3& corner : result.facets[i].facet.corners) {
      corner.z() += 0.07;
    }
  }
  return result;
}

/// Polygons through space with edges of all lengths, some of which cross.
Case network(unsigned seed) {
  Random random(seed);
  FacetedSource source;
  for (int curve = 0; curve < 12; ++curve) {
    Vec3 a = test::random_in_box(random, test::cube(1.0));
    Vec3 direction = test::random_direction(random);
    double length = test::log_uniform(random, 3e-3, 0.1);
    for (int i = 0; i < 50; ++i) {
      direction = (direction + test::random_in_ball(random, 0.3)).normalized();
      length *= test::uniform(random, 0.85, 1.18);
      const Vec3 b = a + length * direction;
      source.segments.push_back({a, b});
      a = b;
    }
  }
  return {"network", mesh_facets(source, 1.3)};
}

/// More facets in one place than an exact leaf keeps.
Case coincident() {
  SizedFacets facets;
  for (int i = 0; i < 60; ++i) {
    facets.push_back({Facet::triangle({0, 0, 0}, {0.6, 0, 0}, {0, 0.5, 0.2}), 0.05, 1.0 / 6.0});
    facets.push_back({Facet::segment({-0.5, 0, 0}, {-0.2, 0.3, 0}), 0.05 + 0.001 * i, 0.3});
    facets.push_back({Facet::point({0, -0.6, 0}), 0.02 + 0.001 * i, 0.5 - 0.005 * i});
  }
  return {"coincident", facets};
}

/// Fifty triangles that meet in one point, as at the tip of a cone.
Case cone() {
  FacetedSource source;
  for (int i = 0; i < 50; ++i) {
    const auto rim = [](int k) {
      const double phi = 2.0 * std::acos(-1.0) * (k % 50) / 50.0;
      return Vec3(0.3 * std::cos(phi), 0.3 * std::sin(phi), 0.5);
    };
    source.triangles.push_back({Vec3(0.01, 0.02, -0.3), rim(i), rim(i + 1)});
  }
  return {"cone", mesh_facets(source, 1.25)};
}

/// A cluster of facets far smaller than the smallest cell that is ever made.
Case far_below_the_smallest_cell() {
  SizedFacets facets;
  for (int i = 0; i < 40; ++i) {
    const double x = 0.3 + 1e-9 * i;
    facets.push_back({Facet::segment({x, 0.1, 0.2}, {x, 0.1 + 1e-8, 0.2}), 1e-8, 0.5});
  }
  return {"far_below_the_smallest_cell", facets};
}

Case steep_growth() {
  Case result = sphere(1000, 6.0);
  result.name = "steep_growth";
  return result;
}

/// Facets outside the box, one of them much smaller than it.
Case sources_outside() {
  return {"sources_outside",
          {{Facet::point({1.6, 0, 0}), 0.01, 0.3},
           {Facet::triangle({-2, -2, -2}, {2, -2, -2}, {0, 2, -2}), 0.3, 0.1},
           {Facet::segment({-1.51, -3, 0}, {-1.51, 3, 0}), 0.05, 0.5}}};
}

/// A 2D model: facets and box in a plane.
Case flat_model(unsigned seed) {
  Random random(seed);
  SizedFacets facets;
  for (int i = 0; i < 200; ++i) {
    Vec3 a = test::random_in_box(random, test::cube(1.0));
    Vec3 b = a + test::random_in_ball(random, 0.2);
    a.z() = b.z() = 0.5;
    facets.push_back({Facet::segment(a, b), test::log_uniform(random, 1e-2, 0.2), 1.0 / 6.0});
  }
  return {"flat_model", facets, 2.0, Box(Vec3(-1.2, -1.1, 0.5), Vec3(1.2, 1.3, 0.5))};
}

Case single(const std::string& name, const Facet& facet) {
  return {name, {{facet, 0.03, 1.0 / 6.0}}};
}

std::vector<Case> all_cases() {
  return {sphere(3000),
          mixed(300, 1e-2, 11),
          mixed(1000, 1e-3, 12),
          degenerate(200, 13),
          plate(20),
          facing_plates(),
          network(14),
          coincident(),
          cone(),
          far_below_the_smallest_cell(),
          steep_growth(),
          sources_outside(),
          flat_model(15),
          single("single_triangle", Facet::triangle({0, 0, 0}, {1, 0, 0.2}, {0, 0.7, 0})),
          single("single_segment", Facet::segment({-0.5, 0, 0.1}, {0.4, 0.3, 0})),
          single("single_point", Facet::point({0.1, 0.2, 0.3}))};
}

// ==== Checks

std::shared_ptr<const FacetTree> tree_of(const SizedFacets& facets) {
  return std::make_shared<const FacetTree>(facets);
}

BackgroundGrid grid_of(const Case& field, double tolerance, int threads = 1,
                       int facets_per_exact_leaf = GridOptions().facets_per_exact_leaf) {
  GridOptions options;
  options.tolerance = tolerance;
  options.threads = threads;
  options.facets_per_exact_leaf = facets_per_exact_leaf;
  return BackgroundGrid(tree_of(field.facets), field.size_limit, field.box, options);
}

/// Half of them within two element sizes of a facet, the others in the cube; of these, half in the
/// middle or on the corners of small cells, where interpolation is worst or changes.
std::vector<Vec3> test_points(const BackgroundGrid& grid, std::size_t count, unsigned seed) {
  Random random(seed);
  const SizedFacets facets(grid.tree().facets().begin(), grid.tree().facets().end());
  const Box cube = grid.cube();
  std::vector<Vec3> points;
  while (points.size() < count) {
    Vec3 p = test::random_in_box(random, cube);
    if (points.size() % 2 == 1 && !facets.empty()) {
      for (int attempt = 0; attempt < 20; ++attempt) {
        const SizedFacet& f = facets[test::random_index(random, facets.size())];
        const Vec3 near = test::random_on_facet(random, f.facet) +
                          test::random_in_ball(random, 2.0 * f.start_size);
        if (cube.contains(near)) {
          p = near;
          break;
        }
      }
    } else if (points.size() % 4 == 2) {
      const double cells = std::pow(2.0, 3.0 + static_cast<double>(test::random_index(random, 8)));
      const double edge = cube.sizes().x() / cells;
      for (int axis = 0; axis < 3; ++axis) {
        const double place = std::floor(2.0 * (p[axis] - cube.min()[axis]) / edge);
        p[axis] = cube.min()[axis] + 0.5 * edge * place;
      }
    }
    points.push_back(p);
  }
  return points;
}

std::string point_text(const Vec3& p) {
  std::ostringstream text;
  text.precision(17);
  text << "at (" << p.transpose() << ")";
  return text.str();
}

/// Both promises of the grid at many points, with exact sizes from the tree; those are compared to
/// a brute-force minimum at some points.
void expect_promises_kept(const BackgroundGrid& grid, double tolerance, std::size_t point_count,
                          unsigned seed) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  const SizedFacets facets(grid.tree().facets().begin(), grid.tree().facets().end());
  const std::vector<Vec3> points = test_points(grid, point_count, seed);
  double worst_over = -1.0;
  Vec3 worst_point = Vec3::Zero();
  std::vector<double> under;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    const double exact = grid.tree().size(p, grid.size_limit());
    const double size = grid.size(p);
    ASSERT_TRUE(size > 0.0 && std::isfinite(size)) << size << ' ' << point_text(p);
    if (i % 100 < 2) {
      const double expected = test::brute_force_size(facets, p, grid.size_limit());
      ASSERT_NEAR(exact, expected, 1e-12 * expected) << point_text(p);
    }
    if (!(size / exact - 1.0 <= worst_over)) {
      worst_over = size / exact - 1.0;
      worst_point = p;
    }
    under.push_back(exact / size - 1.0);
  }
  EXPECT_LE(worst_over, tolerance) << "coarser than asked " << point_text(worst_point);
  const auto place = static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(under.size()));
  std::nth_element(under.begin(), under.begin() + place, under.end());
  EXPECT_LE(under[static_cast<std::size_t>(place)], 2.0 * tolerance) << "finer than asked";
}

void expect_same_bits(double a, double b, const Vec3& p) {
  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): to the bit is what is wanted
  ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0) << a << " and " << b << ' ' << point_text(p);
}

// ==== The promises

class BackgroundGridPromises : public testing::TestWithParam<double> {
 protected:
  static void check(const std::vector<Case>& cases, int facets_per_exact_leaf,
                    unsigned first_seed) {
    unsigned seed = first_seed;
    for (const Case& field : cases) {
      SCOPED_TRACE(field.name);
      const BackgroundGrid grid = grid_of(field, GetParam(), 1, facets_per_exact_leaf);
      expect_promises_kept(grid, GetParam(), 20000, ++seed);
    }
  }
};

TEST_P(BackgroundGridPromises, AreKeptAtEveryPoint) {
  check(all_cases(), GridOptions().facets_per_exact_leaf, 1000);
}

TEST_P(BackgroundGridPromises, AreKeptWithSmallExactLeaves) {
  // Small fields are answered from exact leaves almost everywhere, unless these hold less.
  check(all_cases(), 3, 2000);
}

TEST_P(BackgroundGridPromises, AreKeptByInterpolationAlone) {
  check({sphere(300), plate(8), cone(), sources_outside(),
         single("single_triangle", Facet::triangle({0, 0, 0}, {1, 0, 0.2}, {0, 0.7, 0})),
         single("single_segment", Facet::segment({-0.5, 0, 0.1}, {0.4, 0.3, 0})),
         single("single_point", Facet::point({0.1, 0.2, 0.3}))},
        0, 3000);
}

INSTANTIATE_TEST_SUITE_P(Tolerances, BackgroundGridPromises, testing::Values(0.1, 0.05, 0.02),
                         [](const testing::TestParamInfo<double>& param_info) {
                           return std::to_string(std::lround(100.0 * param_info.param)) +
                                  "_percent";
                         });

TEST(BackgroundGrid, KeepsItsPromisesForManyFacets) {
  expect_promises_kept(grid_of(sphere(10000), 0.05), 0.05, 100000, 1);
}

TEST(BackgroundGrid, KeepsItsPromisesForExtremeTolerances) {
  expect_promises_kept(grid_of(sphere(300), 0.002), 0.002, 20000, 2);
  expect_promises_kept(grid_of(sphere(1000), 1.0), 1.0, 20000, 3);
}

TEST(BackgroundGrid, ExactSizesOfTheTreeEqualTheReference) {
  const Case field = mixed(100, 1e-2, 16);
  const BackgroundGrid grid = grid_of(field, 0.05);
  for (const Vec3& p : test_points(grid, 1000, 5)) {
    const double expected = test::reference_size(field.facets, p, field.size_limit);
    ASSERT_NEAR(grid.tree().size(p, field.size_limit), expected, 1e-12 * expected) << point_text(p);
    ASSERT_LE(grid.size(p), 1.05 * expected) << point_text(p);
  }
}

TEST(BackgroundGrid, KeepsItsPromisesAtAllModelScales) {
  for (const double scale : {1e-9, 1e9}) {
    SCOPED_TRACE("scale " + std::to_string(scale));
    for (Case field : {sphere(1000), mixed(200, 1e-2, 17), plate(8)}) {
      SCOPED_TRACE(field.name);
      for (SizedFacet& f : field.facets) {
        f.start_size *= scale;
        for (Vec3& corner : f.facet.corners) {
          corner *= scale;
        }
      }
      field.size_limit *= scale;
      field.box = Box(scale * field.box.min(), scale * field.box.max());
      expect_promises_kept(grid_of(field, 0.05), 0.05, 20000, 6);
    }
  }
}

TEST(BackgroundGrid, KeepsItsPromisesFarFromTheOrigin) {
  for (const Vec3& offset : {Vec3(1e8, 1e8, 1e8), Vec3(-1e8, 3e7, 0.0)}) {
    for (Case field : {sphere(1000), plate(8), mixed(200, 1e-2, 18)}) {
      SCOPED_TRACE(field.name);
      for (SizedFacet& f : field.facets) {
        for (Vec3& corner : f.facet.corners) {
          corner += offset;
        }
      }
      field.box = Box(field.box.min() + offset, field.box.max() + offset);
      expect_promises_kept(grid_of(field, 0.05), 0.05, 20000, 7);
    }
  }
}

TEST(BackgroundGrid, InterpolatesInMostOfItsVolume) {
  // A grid that asked the tree everywhere would keep the promises, too, and be of no use.
  const BackgroundGrid grid = grid_of(sphere(3000), 0.05);
  const BackgroundGrid::Statistics& statistics = grid.statistics();
  EXPECT_GT(statistics.interpolated_leaves, 1000u);
  EXPECT_GT(statistics.exact_leaves, 0u);
  EXPECT_GT(statistics.depth, 3);
  EXPECT_LE(statistics.depth, 20);
  EXPECT_GT(statistics.bytes, 32 * statistics.interpolated_leaves);
  EXPECT_GE(statistics.seconds, 0.0);
  int interpolated = 0;
  const std::vector<Vec3> points = test_points(grid, 4000, 8);
  for (std::size_t i = 0; i < points.size(); i += 4) {
    interpolated += grid.size(points[i]) != grid.tree().size(points[i], grid.size_limit()) ? 1 : 0;
  }
  EXPECT_GT(interpolated, 500);  // of 1000 in the whole cube
}

// ==== Threads

TEST(BackgroundGrid, IsTheSameToTheBitForAnyNumberOfThreads) {
  for (const Case& field : {sphere(2000), mixed(300, 1e-3, 19), coincident(), plate(10)}) {
    SCOPED_TRACE(field.name);
    const BackgroundGrid one = grid_of(field, 0.05, 1);
    const std::vector<Vec3> points = test_points(one, 20000, 9);
    for (const int threads : {2, 3, 5, 0}) {
      SCOPED_TRACE(std::to_string(threads) + " threads");
      const BackgroundGrid other = grid_of(field, 0.05, threads);
      for (const Vec3& p : points) {
        expect_same_bits(one.size(p), other.size(p), p);
      }
      EXPECT_EQ(one.statistics().interpolated_leaves, other.statistics().interpolated_leaves);
      EXPECT_EQ(one.statistics().exact_leaves, other.statistics().exact_leaves);
      EXPECT_EQ(one.statistics().blocks, other.statistics().blocks);
      EXPECT_EQ(one.statistics().depth, other.statistics().depth);
      EXPECT_EQ(one.statistics().bytes, other.statistics().bytes);
    }
  }
}

TEST(BackgroundGrid, MayBeAskedFromSeveralThreads) {
  const BackgroundGrid grid = grid_of(sphere(1000), 0.05);
  const std::vector<Vec3> points = test_points(grid, 20000, 10);
  std::vector<double> expected;
  for (const Vec3& p : points) {
    expected.push_back(grid.size(p));
  }
  std::vector<std::vector<double>> answers(4);
  std::vector<std::thread> threads;
  for (std::vector<double>& own : answers) {
    threads.emplace_back([&points, &grid, &own] {
      for (const Vec3& p : points) {
        own.push_back(grid.size(p));
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const std::vector<double>& own : answers) {
    EXPECT_EQ(own, expected);
  }
}

// ==== The cube and beyond

TEST(BackgroundGrid, CubeContainsTheBox) {
  for (const Box& box :
       {Box(Vec3(-1, -2, 0), Vec3(0.5, 3, 0.1)), Box(Vec3(5, 5, 5), Vec3(5, 5, 5)),
        Box(Vec3(0, 0, 1), Vec3(1, 0, 1)), Box(Vec3(1e8, 0, 0), Vec3(1e8, 1, 1))}) {
    Case field = single("point", Facet::point({0, 0, 0}));
    field.box = box;
    const Box cube = grid_of(field, 0.05).cube();
    EXPECT_TRUE(cube.contains(box)) << box.min().transpose() << ", " << box.max().transpose();
    // Its corners are rounded to 1.5e-8 at 1e8.
    EXPECT_NEAR(cube.sizes().x(), cube.sizes().y(), 1e-7);
    EXPECT_NEAR(cube.sizes().x(), cube.sizes().z(), 1e-7);
    EXPECT_LE(cube.sizes().x(), 1.001 * box.sizes().maxCoeff() + 1e-3);
  }
}

TEST(BackgroundGrid, PointsOutsideTheCubeGetTheExactSize) {
  const Case field = mixed(200, 1e-2, 20);
  const BackgroundGrid grid = grid_of(field, 0.1);
  Random random(11);
  int outside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = test::random_query(random, field.facets, field.box);
    if (!grid.cube().contains(p)) {
      const double expected = test::brute_force_size(field.facets, p, field.size_limit);
      ASSERT_NEAR(grid.size(p), expected, 1e-12 * expected) << point_text(p);
      ++outside;
    }
  }
  EXPECT_GT(outside, 1000);
  EXPECT_EQ(grid.size({1e200, 0, 0}), field.size_limit);
}

TEST(BackgroundGrid, KeepsItsPromisesOnTheBordersOfBoxAndCube) {
  for (const Case& field : {sphere(1000), sources_outside(), flat_model(21)}) {
    SCOPED_TRACE(field.name);
    const BackgroundGrid grid = grid_of(field, 0.05);
    Random random(12);
    for (const Box& box : {field.box, grid.cube()}) {
      for (int i = 0; i < 3000; ++i) {
        // On a face, on an edge or on a corner; exactly, or one number beside it.
        Vec3 p = test::random_in_box(random, box);
        const std::size_t fixed_axes = 1 + test::random_index(random, 3);
        for (std::size_t k = 0; k < fixed_axes; ++k) {
          const auto axis = static_cast<Eigen::Index>(test::random_index(random, 3));
          p[axis] = test::random_index(random, 2) == 0 ? box.min()[axis] : box.max()[axis];
          const std::size_t beside = test::random_index(random, 3);
          p[axis] = beside == 0   ? p[axis]
                    : beside == 1 ? std::nextafter(p[axis], 1e300)
                                  : std::nextafter(p[axis], -1e300);
        }
        const double exact = test::brute_force_size(field.facets, p, field.size_limit);
        ASSERT_LE(grid.size(p), 1.05 * exact) << point_text(p) << ", seed 12";
        ASSERT_GE(grid.size(p), exact / 1.1) << point_text(p) << ", seed 12";
      }
    }
    for (int corner = 0; corner < 8; ++corner) {
      const auto place = static_cast<Box::CornerType>(corner);
      for (const Vec3& p : {grid.cube().corner(place), field.box.corner(place)}) {
        const double exact = test::brute_force_size(field.facets, p, field.size_limit);
        EXPECT_NEAR(grid.size(p), exact, 0.05 * exact) << point_text(p);
      }
    }
  }
}

TEST(BackgroundGrid, EmptyBoxGivesExactSizes) {
  Case field = mixed(50, 1e-2, 22);
  field.box = Box();
  const BackgroundGrid grid = grid_of(field, 0.05);
  Random random(13);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = i == 0 ? Vec3::Zero() : test::random_query(random, field.facets, test::cube(1));
    const double expected = test::brute_force_size(field.facets, p, field.size_limit);
    ASSERT_NEAR(grid.size(p), expected, 1e-12 * expected) << point_text(p);
  }
}

TEST(BackgroundGrid, BoxOfOnePointIsAllowed) {
  for (const Vec3& place : {Vec3(0, 0, 0), Vec3(3, -4, 5)}) {
    Case field = single("point", Facet::point({0, 0, 0}));
    field.box = Box(place, place);
    const BackgroundGrid grid = grid_of(field, 0.05);
    const double expected = 0.03 + place.norm() / 6.0;
    EXPECT_NEAR(grid.size(place), expected, 1e-6 * expected);
    EXPECT_DOUBLE_EQ(grid.size({0, 0, 1}), 0.03 + 1.0 / 6.0);
  }
}

// ==== Limits and slopes

TEST(BackgroundGrid, SizeLimitIsReachedAndKept) {
  Case field = single("point", Facet::point({0, 0, 0}));
  field.size_limit = 0.1;  // reached at the distance 0.42
  const BackgroundGrid grid = grid_of(field, 0.05);
  for (const Vec3& p : test_points(grid, 5000, 14)) {
    ASSERT_LE(grid.size(p), 0.1 * (1.0 + 1e-6)) << point_text(p);
    if (p.norm() > 1.0) {
      ASSERT_NEAR(grid.size(p), 0.1, 1e-3) << point_text(p);
    }
  }
  expect_promises_kept(grid, 0.05, 20000, 14);
}

TEST(BackgroundGrid, SizeLimitBelowEveryStartSizeGivesAConstant) {
  Case field = sphere(1000);
  field.size_limit = 1e-3;
  const BackgroundGrid grid = grid_of(field, 0.05);
  for (const Vec3& p : test_points(grid, 2000, 15)) {
    ASSERT_NEAR(grid.size(p), 1e-3, 1e-9) << point_text(p);
  }
}

TEST(BackgroundGrid, NoFacetsGiveTheSizeLimit) {
  const BackgroundGrid grid(tree_of({}), 0.7, test::cube(1.0));
  for (const Vec3& p : test_points(grid, 1000, 16)) {
    ASSERT_NEAR(grid.size(p), 0.7, 1e-6);
  }
  EXPECT_EQ(grid.size({5, 5, 5}), 0.7);
}

TEST(BackgroundGrid, GrowthRateOneGivesTheSmallestStartSizeEverywhere) {
  Case field = sphere(1000, 1.0);
  double smallest = FacetTree::infinity;
  for (const SizedFacet& f : field.facets) {
    smallest = std::min(smallest, f.start_size);
  }
  const BackgroundGrid grid = grid_of(field, 0.05);
  for (const Vec3& p : test_points(grid, 2000, 17)) {
    ASSERT_NEAR(grid.size(p), smallest, 1e-6 * smallest) << point_text(p);
  }
  EXPECT_EQ(grid.statistics().interpolated_leaves, 1u);
}

TEST(BackgroundGrid, GrowthRateOneAmongOthers) {
  Case field = sphere(1000);
  field.facets.push_back({Facet::point({0.5, 0.5, 1.2}), 0.1, 0.0});
  const BackgroundGrid grid = grid_of(field, 0.05);
  for (const Vec3& p : test_points(grid, 2000, 18)) {
    ASSERT_LE(grid.size(p), 0.1 * 1.05) << point_text(p);
  }
  expect_promises_kept(grid, 0.05, 20000, 18);
}

// ==== Options

/// What the callback was told.
std::vector<double> progress_of(const Case& field, int threads) {
  std::vector<double> fractions;
  GridOptions options;
  options.threads = threads;
  const std::thread::id caller = std::this_thread::get_id();
  options.progress = [&](double fraction) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    fractions.push_back(fraction);
  };
  const BackgroundGrid grid(tree_of(field.facets), field.size_limit, field.box, options);
  return fractions;
}

void expect_rises_to_one(const std::vector<double>& fractions) {
  ASSERT_FALSE(fractions.empty());
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_GE(fractions.front(), 0.0);
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST(BackgroundGrid, CubeFarLargerThanItsFacetsAnswersExactly) {
  Case field = sphere(300);
  field.size_limit = 1e30;
  field.box = test::cube(1e17);
  const BackgroundGrid grid = grid_of(field, 0.05);
  for (const Vec3& p : {Vec3(0.1, 0.2, 0.3), Vec3(5e15, -1e16, 3e16), Vec3(1e3, 1, 1)}) {
    const double expected = test::brute_force_size(field.facets, p, field.size_limit);
    EXPECT_NEAR(grid.size(p), expected, 1e-12 * expected);
  }
}

TEST(BackgroundGrid, ManySmallFacetsInOnePlaceDoNotMakeCellsBeyondNumber) {
  SizedFacets facets;
  for (int i = 0; i < 500; ++i) {
    facets.push_back(
        {Facet::triangle({0, 0, 0}, {0.3, 0, 0}, {0, 0.3, 0.1}), 1e-6, 0.1 + 0.001 * (i % 100)});
  }
  const Case field{"one place", facets, 1.0};
  const BackgroundGrid grid = grid_of(field, 0.05);
  EXPECT_LT(grid.statistics().bytes, 300u << 20);
  expect_promises_kept(grid, 0.05, 2000, 31);
}

TEST(BackgroundGrid, SizesBeyondFloatAreAnsweredExactly) {
  for (const double scale : {1e-46, 1e-44, 1e39}) {
    const Case field{"scale", {{Facet::point({0, 0, 0}), scale, 0.03}}, 1e300, test::cube(scale)};
    const BackgroundGrid grid = grid_of(field, 0.05, 1, 0);
    const Vec3 p = scale * Vec3(0.3, 0.31, 0.32);
    const double expected = test::brute_force_size(field.facets, p, field.size_limit);
    EXPECT_NEAR(grid.size(p), expected, 0.05 * expected) << scale;
  }
  const BackgroundGrid empty(tree_of({}), FacetTree::infinity, test::cube(1.0));
  EXPECT_EQ(empty.size({0.1, 0.2, 0.3}), FacetTree::infinity);
}

TEST(BackgroundGrid, SizesOfManyPointsAreThoseOfEach) {
  for (const Case& field : {sphere(3000), mixed(300, 1e-2, 21), coincident(), flat_model(22)}) {
    SCOPED_TRACE(field.name);
    const BackgroundGrid grid = grid_of(field, 0.05, 1, 16);
    std::vector<Vec3> points = test_points(grid, 3000, 23);
    points.push_back(Vec3(1e18, 0, 0));
    points.push_back(Vec3(-7, 0.1, 0.2));
    std::vector<double> sizes(points.size());
    const std::size_t interpolated = grid.sizes(points.data(), points.size(), sizes.data());
    std::size_t expected = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      bool is_interpolated = false;
      expect_same_bits(sizes[i], grid.size(points[i], is_interpolated), points[i]);
      expected += is_interpolated ? 1 : 0;
    }
    EXPECT_EQ(interpolated, expected);
    EXPECT_GT(interpolated, 0u);
  }
}

TEST(BackgroundGrid, ProgressRisesToOne) {
  const std::vector<double> fractions = progress_of(sphere(20000), 1);
  expect_rises_to_one(fractions);
  EXPECT_GT(fractions.size(), 10u);
}

TEST(BackgroundGrid, ProgressRisesToOneWithSeveralThreads) {
  const Case field = sphere(2000);
  for (int round = 0; round < 5; ++round) {
    for (const int threads : {2, 3, 5}) {
      SCOPED_TRACE(std::to_string(threads) + " threads, round " + std::to_string(round));
      expect_rises_to_one(progress_of(field, threads));
    }
  }
}

TEST(BackgroundGrid, ProgressRisesToOneForFewCells) {
  // So few that none are left for the threads to share out.
  Case one_cell = sphere(100);
  one_cell.size_limit = 1e-6;
  for (const Case& field : {single("point", Facet::point({0, 0, 0})), one_cell, sphere(300)}) {
    SCOPED_TRACE(field.name + " of " + std::to_string(field.facets.size()));
    expect_rises_to_one(progress_of(field, 1));
    expect_rises_to_one(progress_of(field, 3));
  }
}

TEST(BackgroundGrid, ToleranceOutsideItsRangeIsAnError) {
  const Case field = single("point", Facet::point({0, 0, 0}));
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  for (const double tolerance : {0.0, -0.05, 9e-5, 1.01, FacetTree::infinity, not_a_number}) {
    try {
      grid_of(field, tolerance);
      FAIL() << "no error for " << tolerance;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("tolerance"), std::string::npos) << error.what();
    }
  }
  EXPECT_NO_THROW(grid_of(field, 1e-4));
  EXPECT_NO_THROW(grid_of(field, 1.0));
}

}  // namespace
}  // namespace meshgrow
