// Trees, grids and start sizes that several threads build, also for several fields at once.

#include <gtest/gtest.h>

#include <algorithm>
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

/// A sphere of about so many triangles, each with its longest side for a size.
SizedFacets sphere(std::size_t count) {
  SizedFacets facets;
  for (const auto& [a, b, c] : test::graded_sphere(count, 20.0)) {
    const double size = std::max({(a - b).norm(), (b - c).norm(), (c - a).norm()});
    facets.push_back({Facet::triangle(a, b, c), size, 1.0 / 6.0});
  }
  return facets;
}

/// Of the sizes around and in a sphere, where they are asked for in a larger one.
BackgroundGrid grid_of(std::size_t facets, int threads, std::vector<double>* progress = nullptr) {
  GridOptions options;
  options.tolerance = 0.02;
  options.threads = threads;
  options.facets_per_exact_leaf = 16;
  std::vector<std::array<Vec3, 3>> around = test::graded_sphere(300, 2.0);
  for (auto& triangle : around) {
    for (Vec3& corner : triangle) {
      corner *= 1.5;
    }
  }
  options.region = std::make_shared<AttachedRegion>(around, threads);
  if (progress != nullptr) {
    options.progress = [progress](double done) { progress->push_back(done); };
  }
  return BackgroundGrid(std::make_shared<FacetTree>(sphere(facets), threads), 1.0, test::cube(1.5),
                        options);
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
  const SizedFacets facets = sphere(20000);
  const FacetTree tree(facets, test::thread_count);
  const FacetTree expected(facets, 1);
  ASSERT_EQ(tree.facets().size(), expected.facets().size());
  for (std::size_t i = 0; i < facets.size(); ++i) {
    ASSERT_EQ(tree.original_index(i), expected.original_index(i));
  }
}

TEST(Building, ByFourThreadsGivesTheGridOfOne) {
  constexpr std::size_t facets = 3000;
  std::vector<double> progress;
  const BackgroundGrid grid = grid_of(facets, test::thread_count, &progress);
  EXPECT_EQ(sizes_of(grid), sizes_of(grid_of(facets, 1)));
  EXPECT_EQ(progress.back(), 1.0);
  EXPECT_GT(grid.statistics().blocks, 1000U) << "hardly anything is left to share out";
}

TEST(Building, OfFourFieldsAtOnceByTwoThreadsEach) {
  std::array<std::vector<double>, test::thread_count> sizes;
  test::at_once([&sizes](int thread) {
    sizes[static_cast<std::size_t>(thread)] =
        sizes_of(grid_of(1000 + 200 * static_cast<std::size_t>(thread), 2));
  });
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    EXPECT_EQ(sizes[i], sizes_of(grid_of(1000 + 200 * i, 1))) << "field " << i;
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
