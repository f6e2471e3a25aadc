#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "background_grid.h"
#include "random_facets.h"

namespace meshgrow {
namespace {

TEST(GridLeaves, FillTheCubeAndAnswerAsTheGridDoes) {
  constexpr unsigned seed = 21;
  test::Random random(seed);
  test::RandomFacets wanted;
  wanted.count = 60;
  wanted.smallest_size = 0.05;
  for (const int facets_per_exact_leaf : {0, 8, 192}) {
    const auto tree = std::make_shared<FacetTree>(test::random_facets(random, wanted));
    GridOptions options;
    options.facets_per_exact_leaf = facets_per_exact_leaf;
    options.threads = 1;
    const BackgroundGrid grid(tree, 1.0, test::cube(1.5), options);
    double volume = 0.0;
    std::size_t interpolated = 0;
    std::size_t exact = 0;
    grid.for_each_leaf([&](const GridLeaf& leaf) {
      const double edge = grid.grid_cube().edge * std::ldexp(1.0, -leaf.depth);
      volume += edge * edge * edge;
      const Vec3 lowest = grid.grid_cube().at(leaf.lowest);
      const Vec3 local(test::uniform(random, 0.01, 0.99), test::uniform(random, 0.01, 0.99),
                       test::uniform(random, 0.01, 0.99));
      const Vec3 p = lowest + edge * local;
      bool is_interpolated = false;
      const double size = grid.size(p, is_interpolated);
      ASSERT_EQ(is_interpolated, leaf.sizes != nullptr) << "seed " << seed;
      if (leaf.sizes != nullptr) {
        ++interpolated;
        ASSERT_NEAR(trilinear(*leaf.sizes, local.x(), local.y(), local.z()), size, 1e-9)
            << "seed " << seed;
      } else {
        exact += leaf.keeps_facets ? 1 : 0;
      }
    });
    const Vec3 sides = grid.cube().sizes();
    EXPECT_NEAR(volume, sides.x() * sides.y() * sides.z(), 1e-9);
    EXPECT_EQ(interpolated, grid.statistics().interpolated_leaves);
    EXPECT_EQ(exact, grid.statistics().exact_leaves);
    EXPECT_EQ(exact == 0, facets_per_exact_leaf == 0);
  }
}

}  // namespace
}  // namespace meshgrow
