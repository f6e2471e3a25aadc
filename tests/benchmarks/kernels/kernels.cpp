// Speed, memory and exactness of the facet tree and the background grid, beside CGAL's AABB tree,
// Embree's closest point and the latency of this machine's memory. All inputs are made by code.
//
// Exit status: 1 if an answer is wrong, 2 if the program cannot run as asked; never for a time.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "build_kernels.h"
#include "checks.h"
#include "error.h"
#include "exact_kernels.h"
#include "grid_kernels.h"
#include "inputs.h"
#include "options.h"
#include "peak_memory.h"
#include "progress.h"
#include "results.h"

using namespace meshgrow;
using namespace meshgrow::kernels;

namespace {

const std::vector<std::string> spheres = {"sphere_2e4", "sphere_2e5", "sphere_1e6", "sphere_1e7"};
using FacetCounts = std::map<std::string, std::size_t>;

/// Slope of the least-squares line through the points.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  const auto count = static_cast<double>(x.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / count;
    mean_y += y[i] / count;
  }
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return xy / xx;
}

/// How the seconds of building grow with the facets, repetition by repetition.
void add_exponent(const FacetCounts& facet_counts, const Options& options, Results& results) {
  const bool all = std::all_of(spheres.begin(), spheres.end(), [&](const std::string& sphere) {
    return facet_counts.count(sphere) > 0;
  });
  if (!all || !options.wants("scale.exponent")) {
    return;
  }
  for (int repetition = 0; repetition < options.repetitions; ++repetition) {
    std::vector<double> facets;
    std::vector<double> seconds;
    for (const std::string& sphere : spheres) {
      facets.push_back(std::log(static_cast<double>(facet_counts.at(sphere))));
      seconds.push_back(std::log(results.values({"grid.build.seconds", sphere})[repetition]));
    }
    results.add({"scale.exponent"}, slope(facets, seconds));
  }
}

void add_peak_memory(const std::string& input_name, const Options& options, Results& results) {
  if (input_name == spheres.back() && options.wants("scale.peak_gib_1e7")) {
    results.add({"scale.peak_gib_1e7"}, peak_gib_of_child(input_name));
  }
}

void measure_input(const Input& input, const Options& options, Results& results, Checks& checks) {
  Built built;
  {
    CgalPeer cgal(input.facets);
    if (wants_build_kernels(options)) {
      built = measure_build_kernels(input, cgal, options, results);
    } else {
      built.tree = build_tree(input, 1);
    }
    check_exact_sizes(input, *built.tree, checks);
    if (wants_exact_kernels(options)) {
      if (!wants_build_kernels(options)) {
        cgal.build();
      }
      measure_exact_kernels(input, *built.tree, cgal, options, results, checks);
    }
  }
  if (built.grid == nullptr && wants_grid_kernels(options)) {
    built.grid = build_grid(input, built.tree, 0);
  }
  if (built.grid != nullptr) {
    measure_grid_kernels(input, *built.grid, options, results, checks);
  }
}

bool wants_inputs(const Options& options) {
  return wants_build_kernels(options) || wants_exact_kernels(options) ||
         wants_grid_kernels(options);
}

bool measure_all(const Options& options) {
  if (!wants_inputs(options) && !options.wants("scale.peak_gib_1e7")) {
    throw Error("No number's name begins with what --only says.");
  }
  Results results;
  Checks checks;
  FacetCounts facet_counts;
  for (const std::string& name : options.inputs) {
    progress("%s", name.c_str());
    add_peak_memory(name, options, results);
    if (!wants_inputs(options)) {
      continue;
    }
    const Input input = make_input(name);
    progress("  %zu facets", input.facets.size());
    facet_counts[name] = input.facets.size();
    measure_input(input, options, results, checks);
    // After each input, so that a run that is broken off leaves something behind.
    if (!options.json.empty()) {
      results.merge_into(options.json);
    }
  }
  add_exponent(facet_counts, options, results);
  if (!options.json.empty()) {
    results.merge_into(options.json);
  }
  results.print();
  return checks.passed();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options = parse_options(argc, argv);
    if (!options.peak_of.empty()) {
      print_peak_memory(options.peak_of);
      return 0;
    }
    return measure_all(options) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kernel_benchmarks: %s\n%s", error.what(), usage().c_str());
    return 2;
  }
}
