// Grid against exact sizes at random points: whether the grid keeps its promise, and at what cost.
// The size tolerance is the first argument (default 0.05), the number of facets the second.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include "background_grid.h"
#include "graded_sphere.h"
#include "growth_law.h"
#include "start_sizes/mesh_start_sizes.h"

using namespace meshgrow;

int main(int argc, char** argv) {
  const double tolerance = argc > 1 ? std::atof(argv[1]) : 0.05;
  const std::size_t facet_count = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 20000;
  constexpr std::size_t point_count = 1000000;
  constexpr unsigned seed = 20260722;

  FacetedSource source;
  source.triangles = test::graded_sphere(facet_count, 20.0);
  SizedFacets facets;
  append_mesh_start_sizes(source, QuadSize::triangles, growth_slope(1.2), facets);
  const auto seconds_since = [](std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  auto start = std::chrono::steady_clock::now();
  const auto tree = std::make_shared<FacetTree>(facets);
  const double tree_seconds = seconds_since(start);
  GridOptions options;
  options.tolerance = tolerance;
  const Box box(Vec3::Constant(-1.5), Vec3::Constant(1.5));
  const BackgroundGrid grid(tree, 2.0, box, options);

  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < point_count; ++i) {
    if (i % 2 == 0) {
      const Vec3 local(unit(random), unit(random), unit(random));
      points.push_back(box.min() + local.cwiseProduct(box.sizes()));
      continue;
    }
    // Within two element sizes of the source.
    const SizedFacet& f = facets[static_cast<std::size_t>(unit(random) * facets.size())];
    const double u = unit(random);
    const double v = unit(random) * (1.0 - u);
    const auto& c = f.facet.corners;
    const Vec3 on = c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]);
    Vec3 away;
    do {
      away = Vec3(unit(random), unit(random), unit(random)) * 2.0 - Vec3::Ones();
    } while (away.norm() > 1.0);
    points.push_back(on + 2.0 * f.start_size * away);
  }
  start = std::chrono::steady_clock::now();
  std::vector<double> exact;
  for (const Vec3& p : points) {
    exact.push_back(tree->size(p, 2.0));
  }
  const double exact_seconds = seconds_since(start);
  start = std::chrono::steady_clock::now();
  std::vector<double> interpolated;
  for (const Vec3& p : points) {
    interpolated.push_back(grid.size(p));
  }
  const double grid_seconds = seconds_since(start);

  double worst_over = -1.0;
  std::vector<double> under;
  double mean_under = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    worst_over = std::max(worst_over, interpolated[i] / exact[i] - 1.0);
    under.push_back(std::max(0.0, exact[i] / interpolated[i] - 1.0));
    mean_under += under.back() / static_cast<double>(points.size());
  }
  std::sort(under.begin(), under.end());
  const BackgroundGrid::Statistics& s = grid.statistics();
  std::printf(
      "tolerance %4.1f %%, %zu facets, seed %u: tree %.2f s; grid %.2f s, %zu interpolated + %zu "
      "exact cells, depth %d, %.1f MB (tree %.1f MB)\n"
      "  grid/exact - 1: max %.4f (promise %.4f); exact/grid - 1: mean %.4f, 99.9 %% %.4f, max "
      "%.4f\n  a size: tree %.0f ns, grid %.0f ns (random points, one thread)\n",
      100.0 * tolerance, facets.size(), seed, tree_seconds, s.seconds, s.interpolated_leaves,
      s.exact_leaves, s.depth, static_cast<double>(s.bytes) / 1e6,
      static_cast<double>(tree->memory_bytes()) / 1e6, worst_over, tolerance, mean_under,
      under[under.size() * 999 / 1000], under.back(), 1e9 * exact_seconds / point_count,
      1e9 * grid_seconds / point_count);
  return worst_over <= tolerance ? 0 : 1;
}
