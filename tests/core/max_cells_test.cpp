// The limit of a background grid's memory.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "available_memory.h"
#include "background_grid.h"
#include "cell_budget.h"
#include "error.h"
#include "graded_sphere.h"
#include "growth_law.h"
#include "random_facets.h"
#include "start_sizes/mesh_start_sizes.h"

namespace meshgrow {
namespace {

constexpr double tolerance = 0.02;
constexpr double size_limit = 2.0;

std::shared_ptr<const FacetTree> sphere_tree() {
  FacetedSource source;
  source.triangles = test::graded_sphere(1000, 20.0);
  SizedFacets facets;
  append_mesh_start_sizes(source, QuadSize::triangles, growth_slope(1.3), facets);
  return std::make_shared<const FacetTree>(std::move(facets));
}

BackgroundGrid grid_with(std::size_t max_cells, int threads = 1, int facets_per_exact_leaf = 30) {
  GridOptions options;
  options.tolerance = tolerance;
  options.threads = threads;
  options.facets_per_exact_leaf = facets_per_exact_leaf;
  options.max_cells = max_cells;
  return BackgroundGrid(sphere_tree(), size_limit, test::cube(1.5), options);
}

std::size_t cells_of(const BackgroundGrid& grid) {
  std::size_t cells = 0;
  grid.for_each_leaf([&cells](const GridLeaf&) { ++cells; });
  return cells;
}

TEST(MaxCells, AreKept) {
  const BackgroundGrid whole = grid_with(0);
  EXPECT_FALSE(whole.statistics().is_limited);
  const std::size_t needed = cells_of(whole);
  for (const std::size_t most : {std::size_t{8}, needed / 100, needed / 10, needed / 2}) {
    SCOPED_TRACE(most);
    const BackgroundGrid grid = grid_with(most);
    EXPECT_TRUE(grid.statistics().is_limited);
    EXPECT_EQ(grid.statistics().max_cells, most);
    EXPECT_LE(cells_of(grid), most);
    EXPECT_LE(grid.statistics().bytes, bytes_per_cell * most + 1000);
    EXPECT_LT(grid.statistics().depth, whole.statistics().depth);
  }
}

TEST(MaxCells, AreUsedAsFarAsOneDepthMoreWouldBeTooMany) {
  const std::size_t needed = cells_of(grid_with(0));
  // Each depth has at most eight times the cells of the one before.
  EXPECT_GT(cells_of(grid_with(needed / 2)), needed / 2 / 9);
}

TEST(MaxCells, ThatSufficeChangeNothing) {
  const BackgroundGrid whole = grid_with(0);
  const BackgroundGrid grid = grid_with(4 * cells_of(whole));
  EXPECT_FALSE(grid.statistics().is_limited);
  EXPECT_EQ(cells_of(grid), cells_of(whole));
}

TEST(MaxCells, LeaveThePromiseOfTheGrid) {
  const BackgroundGrid whole = grid_with(0);
  const BackgroundGrid grid = grid_with(cells_of(whole) / 10);
  test::Random random(31);
  std::size_t exact_instead = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = test::random_in_box(random, grid.cube());
    const double exact = grid.tree().size(p, size_limit);
    bool interpolated = false;
    ASSERT_LE(grid.size(p, interpolated), (1.0 + tolerance) * exact) << p.transpose();
    bool was_interpolated = false;
    whole.size(p, was_interpolated);
    exact_instead += was_interpolated && !interpolated ? 1 : 0;
  }
  EXPECT_GT(exact_instead, 0u) << "the limit made no difference";
  EXPECT_LT(exact_instead, 15000u) << "hardly anything is interpolated";
}

TEST(MaxCells, GiveTheSameGridForAnyNumberOfThreads) {
  const std::size_t most = cells_of(grid_with(0)) / 5;
  const BackgroundGrid one = grid_with(most, 1);
  const BackgroundGrid four = grid_with(most, 4);
  ASSERT_EQ(one.stored().blocks.size(), four.stored().blocks.size());
  EXPECT_EQ(std::memcmp(one.stored().blocks.data(), four.stored().blocks.data(),
                        one.stored().blocks.bytes()),
            0);
  ASSERT_EQ(one.stored().corners.size(), four.stored().corners.size());
  EXPECT_EQ(std::memcmp(one.stored().corners.data(), four.stored().corners.data(),
                        one.stored().corners.bytes()),
            0);
}

TEST(MaxCells, CountFacetsThatCellsKeep) {
  // The same cells with more in them: fewer fit.
  const std::size_t most = cells_of(grid_with(0, 1, 500));
  EXPECT_GT(grid_with(0, 1, 500).statistics().exact_leaves, 0u);
  EXPECT_LE(grid_with(most, 1, 500).statistics().bytes, bytes_per_cell * most + 1000);
}

TEST(MaxCells, TellTheToleranceThatInterpolationReaches) {
  const std::size_t needed = cells_of(grid_with(0, 1, 0));
  const BackgroundGrid grid = grid_with(needed / 20, 1, 0);
  const double reached = grid.statistics().tolerance;
  EXPECT_GT(reached, tolerance);
  EXPECT_TRUE(std::isfinite(reached));
  // Between exact sizes at the corners of the cells that the tree answers.
  test::Random random(32);
  const FacetTree& tree = grid.tree();
  double worst = 0.0;
  grid.for_each_leaf([&](const GridLeaf& leaf) {
    if (leaf.sizes != nullptr || leaf.keeps_facets) {
      return;
    }
    GridCell cell;
    cell.lowest = leaf.lowest;
    cell.depth = leaf.depth;
    std::array<double, 8> sizes;
    for (int i = 0; i < 8; ++i) {
      sizes[i] = tree.size(grid.grid_cube().at(cell.corner(i)), size_limit);
    }
    for (int trial = 0; trial < 20; ++trial) {
      const Vec3 local = test::random_in_box(random, Box(Vec3::Zero(), Vec3::Ones()));
      const Vec3 p =
          grid.grid_cube().at(cell.lowest) + 2.0 * cell.half_edge(grid.grid_cube()) * local;
      const double exact = tree.size(p, size_limit);
      const double between = trilinear(sizes, local.x(), local.y(), local.z());
      worst = std::max(worst, std::abs(between - exact) / exact);
    }
  });
  EXPECT_GT(worst, tolerance);
  EXPECT_LE(worst, reached * (1.0 + 1e-9));
}

TEST(MaxCells, LetProgressRiseAlthoughBuildingIsBegunAnew) {
  std::vector<double> told;
  GridOptions options;
  options.tolerance = tolerance;
  options.threads = 1;
  options.facets_per_exact_leaf = 30;
  options.max_cells = cells_of(grid_with(0)) / 2;
  options.progress = [&told](double done) { told.push_back(done); };
  const BackgroundGrid grid(sphere_tree(), size_limit, test::cube(1.5), options);
  EXPECT_TRUE(grid.statistics().is_limited);
  EXPECT_GT(told.size(), 100u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1.0);
}

TEST(MaxCells, OutsideTheirRangeAreAnError) {
  for (const double wrong : {7.0, -1.0, 4.1e8, std::nan("")}) {
    EXPECT_THROW(check_max_cells(wrong), Error) << wrong;
  }
  EXPECT_NO_THROW(check_max_cells(0.0));
  EXPECT_NO_THROW(check_max_cells(8.0));
  EXPECT_NO_THROW(check_max_cells(4e8));
}

TEST(MaxCells, ByDefaultFitIntoAvailableMemory) {
  EXPECT_GT(available_memory(), std::size_t{1} << 20);
  const std::size_t cells = default_max_cells();
  EXPECT_GE(cells, 1000u);
  EXPECT_LE(cells, most_cells_of_all);
  // Twice, as other programs may just have given something back.
  EXPECT_LE(std::min(cells, most_cells_of_all) * bytes_per_cell, 2 * available_memory());
}

}  // namespace
}  // namespace meshgrow
