// What background grids promise, whatever the facets are, the box and the options.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "background_grid.h"
#include "property_rounds.h"
#include "random_models.h"

namespace meshgrow {
namespace {

using test::Random;
using test::RandomModel;
using test::text_of;

constexpr std::size_t most_facets = 300;

struct RandomGrid {
  RandomModel model;
  GridOptions options;
  std::string text;

  RandomGrid(Random& random, std::size_t facets) : model(test::random_model(random, facets)) {
    options.tolerance = test::log_uniform(random, 0.02, 0.5);
    options.threads = 1;
    options.facets_per_exact_leaf = test::one_of(random, std::array<int, 5>{1, 3, 16, 96, 192});
    std::ostringstream written;
    written << model.name << ", tolerance " << options.tolerance << ", "
            << options.facets_per_exact_leaf << " facets an exact leaf";
    text = written.str();
  }

  BackgroundGrid build() const { return build(model); }
  BackgroundGrid build(const RandomModel& other) const {
    return BackgroundGrid(std::make_shared<const FacetTree>(other.facets), other.size_limit,
                          other.box, options);
  }
};

double exact_size(const BackgroundGrid& grid, const Vec3& p) {
  return grid.tree().size(p, grid.size_limit());
}

/// At a corner, in the middle of a face or an edge, or in the middle of a leaf, or one number
/// beside it: where answers come from one cell here and from another there.
Vec3 random_place_of(Random& random, const GridLeaf& leaf, const GridCube& cube) {
  const double half = 0.5 * static_cast<double>(1u << (max_grid_depth - leaf.depth));
  Vec3 place(leaf.lowest.x, leaf.lowest.y, leaf.lowest.z);
  for (int axis = 0; axis < 3; ++axis) {
    place[axis] += half * static_cast<double>(test::random_index(random, 3));
  }
  Vec3 p = cube.origin + cube.step() * place;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t beside = test::random_index(random, 4);
    p[axis] = beside == 0   ? std::nextafter(p[axis], 1e300)
              : beside == 1 ? std::nextafter(p[axis], -1e300)
                            : p[axis];
  }
  return p;
}

/// Points of the model, and of leaves of the grid.
std::vector<Vec3> points_for(Random& random, const RandomModel& model, const BackgroundGrid& grid,
                             std::size_t count) {
  std::vector<Vec3> points = test::random_points(random, model, count / 2);
  std::vector<GridLeaf> leaves;
  grid.for_each_leaf([&](const GridLeaf& leaf) { leaves.push_back(leaf); });
  while (points.size() < count) {
    points.push_back(random_place_of(random, leaves[test::random_index(random, leaves.size())],
                                     grid.grid_cube()));
  }
  return points;
}

void expect_never_coarser(const BackgroundGrid& grid, double tolerance,
                          const std::vector<Vec3>& points) {
  std::vector<double> sizes(points.size());
  grid.sizes(points.data(), points.size(), sizes.data());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double exact = exact_size(grid, points[i]);
    const double size = grid.size(points[i]);
    ASSERT_LE(size, (1.0 + tolerance) * exact) << text_of(points[i]);
    ASSERT_GT(size, 0.0) << text_of(points[i]);
    ASSERT_EQ(sizes[i], size) << "of many, " << text_of(points[i]);
  }
}

// ==== The certificate

TEST(GridProperties, AreNeverCoarserThanAskedAtAnyPoint) {
  test::for_random_rounds(60, [](Random& random) {
    const RandomGrid drawn(random, most_facets);
    SCOPED_TRACE(drawn.text);
    const BackgroundGrid grid = drawn.build();
    expect_never_coarser(grid, drawn.options.tolerance,
                         points_for(random, drawn.model, grid, 1000));
  });
}

TEST(GridProperties, AreNeverCoarserThanAskedWhereTheLimitCutsThroughCells) {
  // Few facets, each with a slope of its own, and a limit that is reached in the middle of them.
  test::for_random_rounds(100, [](Random& random) {
    RandomGrid drawn(random, 20);
    drawn.model.facets.clear();
    for (std::size_t i = 8 * (1 + test::random_index(random, 4)); i > 0; --i) {
      const Vec3 a = test::random_in_box(random, test::cube(2.0));
      const Vec3 b = a + test::random_in_ball(random, 2.0);
      drawn.model.facets.push_back({Facet::segment(a, b), test::log_uniform(random, 1e-3, 0.5),
                                    test::uniform(random, 0.02, 0.9)});
    }
    drawn.model.box = test::cube(1.0);
    const Vec3 reached = test::random_in_box(random, drawn.model.box);
    drawn.model.size_limit = FacetTree(drawn.model.facets).size(reached);
    SCOPED_TRACE(drawn.text);
    const BackgroundGrid grid = drawn.build();
    expect_never_coarser(grid, drawn.options.tolerance, points_for(random, drawn.model, grid, 500));
  });
}

/// A steep plate and a gentle one that rules nowhere but between the steep one and the limit. At
/// the centre of the cube the steep plate rules, at its corners that or the limit.
RandomModel two_plates() {
  const auto plate = [](double x, double start_size, double slope) {
    return SizedFacet{Facet::triangle({x, -90, -90}, {x, 90, -90}, {x, 0, 180}), start_size, slope};
  };
  RandomModel model;
  model.facets.assign(8, plate(-1.05, 0.05, 0.9));
  model.facets.insert(model.facets.end(), 8, plate(-3.0, 0.097, 0.3));
  model.size_limit = 1.29;
  model.box = test::cube(1.0);
  return model;
}

BackgroundGrid interpolating_grid(const RandomModel& model) {
  GridOptions options;
  options.threads = 1;
  options.facets_per_exact_leaf = 0;
  return BackgroundGrid(std::make_shared<const FacetTree>(model.facets), model.size_limit,
                        model.box, options);
}

TEST(GridProperties, AreNeverCoarserThanAskedBetweenASteepSlopeAndTheLimit) {
  RandomModel model = two_plates();
  // At one corner a small point rules, so that the cube is divided.
  model.facets.insert(model.facets.end(), 8, {Facet::point({-1, 1, 1}), 0.001, 0.9});
  const BackgroundGrid grid = interpolating_grid(model);
  Random random(1);
  std::vector<Vec3> points;
  points.reserve(1000);
  for (int i = 0; i < 1000; ++i) {
    points.push_back(test::random_in_box(random, model.box));
  }
  expect_never_coarser(grid, GridOptions().tolerance, points);
}

TEST(GridProperties, AreNotMuchFinerThanAskedBetweenASteepSlopeAndTheLimit) {
  const BackgroundGrid grid = interpolating_grid(two_plates());
  for (double x = -0.99; x < 1.0; x += 0.01) {
    const Vec3 p(x, 0.1, 0.2);
    EXPECT_GE(grid.size(p) * (1.0 + 2.0 * GridOptions().tolerance), exact_size(grid, p)) << x;
  }
}

TEST(GridProperties, AreNotMuchFinerThanAsked) {
  // At the centre of a cell that interpolates it is checked or proven (cell_classifier.h), and so
  // it is wherever facets answer; of other points 999 of 1000 are as good.
  std::size_t asked = 0;
  std::size_t too_fine = 0;
  test::for_random_rounds(60, [&](Random& random) {
    const RandomGrid drawn(random, most_facets);
    SCOPED_TRACE(drawn.text);
    const BackgroundGrid grid = drawn.build();
    const double t = drawn.options.tolerance;
    const double least = std::min(1.0 - t, 1.0 / (1.0 + 2.0 * t)) * (1.0 - 2e-5);
    grid.for_each_leaf([&](const GridLeaf& leaf) {
      const double half = 0.5 * static_cast<double>(1u << (max_grid_depth - leaf.depth));
      const GridCube& cube = grid.grid_cube();
      const Vec3 centre =
          cube.origin +
          cube.step() * (Vec3(leaf.lowest.x, leaf.lowest.y, leaf.lowest.z) + Vec3::Constant(half));
      if (leaf.sizes == nullptr || test::random_index(random, 20) == 0) {
        const double bound = leaf.sizes == nullptr ? 1.0 - 2e-5 : least;
        EXPECT_GE(grid.size(centre), bound * exact_size(grid, centre)) << text_of(centre);
      }
    });
    for (int i = 0; i < 1000; ++i) {
      const Vec3 p = test::random_in_box(random, grid.cube());
      ++asked;
      too_fine += grid.size(p) * (1.0 + 2.0 * t) < exact_size(grid, p) ? 1 : 0;
    }
  });
  EXPECT_LE(static_cast<double>(too_fine), 1e-3 * static_cast<double>(asked));
}

TEST(GridProperties, AreExactOutsideOfTheCube) {
  test::for_random_rounds(60, [](Random& random) {
    const RandomGrid drawn(random, 100);
    SCOPED_TRACE(drawn.text);
    const BackgroundGrid grid = drawn.build();
    for (int i = 0; i < 200; ++i) {
      Vec3 p = test::random_point(random, drawn.model);
      if (i % 2 == 0) {
        p = test::random_in_box(random, grid.cube());
        const auto axis = static_cast<Eigen::Index>(test::random_index(random, 3));
        p[axis] = test::random_index(random, 2) == 0
                      ? std::nextafter(grid.cube().min()[axis], -1e300)
                      : std::nextafter(grid.cube().max()[axis], 1e300);
      }
      if (!grid.cube().contains(p)) {
        ASSERT_EQ(grid.size(p), exact_size(grid, p)) << text_of(p);
      }
    }
  });
}

// ==== Where sizes are asked for

std::vector<std::array<Vec3, 3>> random_region(Random& random, const RandomModel& model) {
  const double size = std::max(model.box.sizes().maxCoeff(), 0.1);
  std::vector<std::array<Vec3, 3>> triangles;
  for (std::size_t bodies = 1 + test::random_index(random, 3); bodies > 0; --bodies) {
    const Vec3 centre = test::random_in_box(random, model.box);
    const Vec3 radii(size * test::uniform(random, 0.01, 0.6),
                     size * test::uniform(random, 0.1, 0.6),
                     size * test::uniform(random, 0.1, 0.6));
    for (auto triangle : test::graded_sphere(200, 3.0)) {
      for (Vec3& corner : triangle) {
        corner = centre + corner.cwiseProduct(radii);
      }
      triangles.push_back(triangle);
    }
  }
  return triangles;
}

TEST(GridProperties, AreNeverCoarserThanAskedWithARegionEither) {
  test::for_random_rounds(60, [](Random& random) {
    RandomGrid drawn(random, most_facets);
    SCOPED_TRACE(drawn.text);
    const auto triangles = random_region(random, drawn.model);
    drawn.options.region = std::make_shared<AttachedRegion>(triangles);
    const BackgroundGrid grid = drawn.build();
    std::vector<Vec3> points = points_for(random, drawn.model, grid, 500);
    for (int i = 0; i < 500; ++i) {
      const auto& [a, b, c] = triangles[test::random_index(random, triangles.size())];
      points.push_back(test::random_on_facet(random, Facet::triangle(a, b, c)));
    }
    expect_never_coarser(grid, drawn.options.tolerance, points);
    drawn.options.region = nullptr;
    EXPECT_LE(grid.statistics().interpolated_leaves,
              drawn.build().statistics().interpolated_leaves);
  });
}

// ==== Invariance

void expect_same_cells(const BackgroundGrid& a, const BackgroundGrid& b) {
  EXPECT_EQ(a.statistics().interpolated_leaves, b.statistics().interpolated_leaves);
  EXPECT_EQ(a.statistics().exact_leaves, b.statistics().exact_leaves);
  EXPECT_EQ(a.statistics().depth, b.statistics().depth);
}

/// A tenth more or less, and a few: cells that just did or just did not have to be split.
void expect_about_as_many_cells(const BackgroundGrid& a, const BackgroundGrid& b) {
  const auto cells = [](const BackgroundGrid& grid) {
    return static_cast<double>(grid.statistics().interpolated_leaves +
                               grid.statistics().exact_leaves);
  };
  EXPECT_LE(cells(b), 1.1 * cells(a) + 100.0);
  EXPECT_LE(cells(a), 1.1 * cells(b) + 100.0);
}

TEST(GridProperties, ScaleWithTheModelToTheBitByPowersOfTwo) {
  test::for_random_rounds(40, [](Random& random) {
    const RandomGrid drawn(random, most_facets);
    SCOPED_TRACE(drawn.text);
    const double scale = std::ldexp(1.0, static_cast<int>(test::random_index(random, 61)) - 30);
    const BackgroundGrid grid = drawn.build();
    const BackgroundGrid scaled = drawn.build(test::mapped(
        drawn.model, [=](const Vec3& p) { return Vec3(scale * p); }, scale));
    expect_same_cells(grid, scaled);
    for (const Vec3& p : points_for(random, drawn.model, grid, 200)) {
      ASSERT_EQ(scaled.size(scale * p), scale * grid.size(p)) << text_of(p) << ", scale " << scale;
    }
  });
}

/// The promise holds for the changed model as well, and it does not take many more cells.
template <typename Map>
void expect_as_good(Random& random, const RandomGrid& drawn, Map map, double scale) {
  SCOPED_TRACE("scale " + std::to_string(scale));
  const RandomModel changed = test::mapped(drawn.model, map, scale);
  const BackgroundGrid grid = drawn.build();
  const BackgroundGrid other = drawn.build(changed);
  expect_about_as_many_cells(grid, other);
  expect_never_coarser(other, drawn.options.tolerance, points_for(random, changed, other, 300));
}

TEST(GridProperties, AreAsGoodAtEveryScale) {
  test::for_random_rounds(40, [](Random& random) {
    const RandomGrid drawn(random, most_facets);
    SCOPED_TRACE(drawn.text);
    const double scale = test::log_uniform(random, 1e-9, 1e9);
    expect_as_good(
        random, drawn, [=](const Vec3& p) { return Vec3(scale * p); }, scale);
  });
}

TEST(GridProperties, AreAsGoodInEveryPlace) {
  // A million times as far away as the model is large, coordinates still have ten digits.
  test::for_random_rounds(40, [](Random& random) {
    const RandomGrid drawn(random, most_facets);
    SCOPED_TRACE(drawn.text);
    const Vec3 way = test::log_uniform(random, 1e-3, 1e6) * test::random_direction(random);
    expect_as_good(
        random, drawn, [=](const Vec3& p) { return Vec3(p + way); }, 1.0);
  });
}

TEST(GridProperties, AreAsGoodForFacetsInAnyOrderAndRepeated) {
  test::for_random_rounds(40, [](Random& random) {
    const RandomGrid drawn(random, most_facets);
    SCOPED_TRACE(drawn.text);
    RandomModel changed = drawn.model;
    for (std::size_t i = test::random_index(random, 10); i > 0; --i) {
      changed.facets.push_back(changed.facets[test::random_index(random, changed.facets.size())]);
    }
    std::shuffle(changed.facets.begin(), changed.facets.end(), random);
    const BackgroundGrid grid = drawn.build();
    const BackgroundGrid other = drawn.build(changed);
    expect_never_coarser(other, drawn.options.tolerance, points_for(random, changed, other, 300));
    // The sizes at the corners of cells are exact ones, which do not depend on the order.
    for (const Vec3& p : test::random_points(random, drawn.model, 100)) {
      ASSERT_EQ(exact_size(other, p), exact_size(grid, p)) << text_of(p);
    }
  });
}

TEST(GridProperties, AreTheSameToTheBitForAnyNumberOfThreads) {
  test::for_random_rounds(20, [](Random& random) {
    RandomGrid drawn(random, most_facets);
    SCOPED_TRACE(drawn.text);
    const BackgroundGrid grid = drawn.build();
    drawn.options.threads = 3;
    const BackgroundGrid other = drawn.build();
    expect_same_cells(grid, other);
    for (const Vec3& p : points_for(random, drawn.model, grid, 300)) {
      ASSERT_EQ(other.size(p), grid.size(p)) << text_of(p);
    }
  });
}

}  // namespace
}  // namespace meshgrow
