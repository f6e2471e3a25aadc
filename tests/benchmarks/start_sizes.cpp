// Start sizes of curvature and proximity against the building of a grid from them, for a shell
// between two spheres of so many triangles in all (first argument, default 100000).

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "background_grid.h"
#include "graded_sphere.h"
#include "growth_law.h"
#include "start_sizes/curvature_start_sizes.h"
#include "start_sizes/proximity_start_sizes.h"

using namespace meshgrow;

namespace {

FacetedSource sphere(const Entity& entity, double radius, std::size_t triangle_count) {
  FacetedSource source;
  source.entity = entity;
  for (const auto& [a, b, c] : test::graded_sphere(triangle_count, 4.0)) {
    source.triangles.push_back({radius * a, radius * b, radius * c});
  }
  return source;
}

double grid_seconds(SizedFacets facets, double size_limit) {
  GridOptions options;
  const Box box(Vec3::Constant(-1.0), Vec3::Constant(1.0));
  const auto tree = std::make_shared<FacetTree>(std::move(facets));
  return BackgroundGrid(tree, size_limit, box, options).statistics().seconds;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 100000;
  const std::vector<FacetedSource> faces = {sphere({2, 1}, 1.0, count / 2),
                                            sphere({2, 2}, 0.8, count / 2)};
  constexpr double size_limit = 0.5;
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const auto report = [&](const char* kind, SizedFacets facets, double seconds) {
    const std::size_t facet_count = facets.size();
    const double grid = grid_seconds(std::move(facets), size_limit);
    std::printf("%-10s %9zu facets: start sizes %7.2f s, grid %7.2f s, ratio %.3f\n", kind,
                facet_count, seconds, grid, seconds / grid);
  };

  SizedFacets curvature;
  auto start = Clock::now();
  for (const FacetedSource& face : faces) {
    append_curvature_start_sizes(face, {18.0, 0.0, size_limit}, growth_slope(1.2), curvature);
  }
  double seconds = seconds_since(start);
  report("curvature", std::move(curvature), seconds);

  SizedFacets proximity;
  start = Clock::now();
  ProximityParameters parameters;
  parameters.size_limit = size_limit;
  append_proximity_start_sizes(volume_walls(faces), {{2, 1}, {2, 2}}, parameters, proximity);
  seconds = seconds_since(start);
  report("proximity", std::move(proximity), seconds);
  return 0;
}
