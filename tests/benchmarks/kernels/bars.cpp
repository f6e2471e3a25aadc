#include "bars.h"

#include <map>

#include "inputs.h"

namespace meshgrow::kernels {

std::optional<Bar> bar_of(const Path& path) {
  const std::string& name = path.front();
  if (name == "exact.vs_cgal.near" || name == "exact.vs_cgal.volume") {
    const bool on_sphere = path.size() > 1 && path[1].compare(0, 7, "sphere_") == 0;
    return Bar{on_sphere ? 8.0 : 4.0, true};
  }
  static const std::map<std::string, Bar> bars = {
      {"exact.vs_embree.near", {1.5, true}},       {"tree.build.vs_cgal", {1.5, true}},
      {"grid.build.vs_projection", {3.0, true}},   {"tree.vs_projection", {6.0, true}},
      {"grid.build.threads2", {1.8, true}},        {"grid.leaf_bytes", {40.0, false}},
      {"grid.bytes_per_facet", {300.0, false}},    {"grid.max_over", {tolerance, false}},
      {"grid.p999_under", {0.10, false}},          {"grid.eval.random_vs_latency", {2.0, false}},
      {"grid.eval.batch_vs_single", {0.6, false}}, {"scale.exponent", {1.1, false}},
      {"scale.peak_gib_1e7", {8.0, false}}};
  const auto bar = bars.find(name);
  return bar == bars.end() ? std::nullopt : std::optional<Bar>(bar->second);
}

}  // namespace meshgrow::kernels
