// Trees, grids and start sizes that several threads build, also for several fields at once.

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "at_once.h"
#include "background_grid.h"
#include "graded_sphere.h"
#include "random_facets.h"
#include "region_walls.h"
#include "start_sizes/proximity_start_sizes.h"
#include "wall_shapes.h"

namespace meshgrow {
namespace {

SizedFacets some_facets(unsigned seed, std::size_t count) {
  test::Random random(seed);
  test::RandomFacets wanted;
  wanted.count = count;
  wanted.longest = 0.1;
  wanted.smallest_size = 1e-2;
  wanted.largest_size = 0.1;
  return test::random_facets(random, wanted);
}

BackgroundGrid grid_of(unsigned seed, std::size_t facets, int threads,
                       std::vector<double>* progress = nullptr) {
  GridOptions options;
  options.tolerance = 0.1;
  options.threads = threads;
  options.region = std::make_shared<AttachedRegion>(test::graded_sphere(300, 2.0), threads);
  if (progress != nullptr) {
    options.progress = [progress](double done) { progress->push_back(done); };
  }
  return BackgroundGrid(std::make_shared<FacetTree>(some_facets(seed, facets), threads), 1.0,
                        test::cube(1.0), options);
}

std::vector<double> sizes_of(const BackgroundGrid& grid) {
  test::Random random(7);
  std::vector<double> sizes;
  for (int i = 0; i < 1000; ++i) {
    sizes.push_back(grid.size(test::random_in_box(random, test::cube(1.2))));
  }
  return sizes;
}

TEST(Building, ByFourThreadsGivesTheTreeOfOne) {
  // So many that each thread has several parts of it to lay out.
  const SizedFacets facets = some_facets(1, 20000);
  const FacetTree tree(facets, test::thread_count);
  const FacetTree expected(facets, 1);
  ASSERT_EQ(tree.facets().size(), expected.facets().size());
  for (std::size_t i = 0; i < facets.size(); ++i) {
    ASSERT_EQ(tree.original_index(i), expected.original_index(i));
  }
}

TEST(Building, ByFourThreadsGivesTheGridOfOne) {
  constexpr std::size_t facets = 600;
  std::vector<double> progress;
  const BackgroundGrid grid = grid_of(1, facets, test::thread_count, &progress);
  EXPECT_EQ(sizes_of(grid), sizes_of(grid_of(1, facets, 1)));
  EXPECT_EQ(progress.back(), 1.0);
}

TEST(Building, OfFourFieldsAtOnceByTwoThreadsEach) {
  constexpr std::size_t facets = 200;
  std::array<std::vector<double>, test::thread_count> sizes;
  test::at_once([&sizes](int thread) {
    sizes[static_cast<std::size_t>(thread)] =
        sizes_of(grid_of(static_cast<unsigned>(thread), facets, 2));
  });
  for (unsigned i = 0; i < sizes.size(); ++i) {
    EXPECT_EQ(sizes[i], sizes_of(grid_of(i, facets, 1))) << "seed " << i;
  }
}

TEST(Building, ByFourThreadsGivesTheGapsOfOne) {
  const std::vector<FacetedSource> faces = test::box_faces({-2, -2, -1}, {2, 2, 1}, 3);
  const std::vector<Wall> walls = volume_walls(faces);
  ProximityParameters parameters;
  parameters.size_limit = 10.0;
  std::array<SizedFacets, 2> facets;
  for (const bool several : {false, true}) {
    parameters.threads = several ? test::thread_count : 1;
    append_proximity_start_sizes(walls, test::entities_of(faces), parameters, facets[several]);
  }
  EXPECT_FALSE(facets[0].empty());
  EXPECT_TRUE(facets[0] == facets[1]);
}

}  // namespace
}  // namespace meshgrow
