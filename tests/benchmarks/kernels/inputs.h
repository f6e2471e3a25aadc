#ifndef MESHGROW_BENCHMARKS_KERNELS_INPUTS_H
#define MESHGROW_BENCHMARKS_KERNELS_INPUTS_H

#include <string>
#include <vector>

#include "sized_facets.h"

namespace meshgrow::kernels {

constexpr double growth_rate = 1.2;
constexpr double size_limit = 2.0;
constexpr double tolerance = 0.05;

/// A source made by code, with the start sizes of its own elements.
struct Input {
  std::string name;
  SizedFacets facets;
  Box box;        ///< of the facets
  Box query_box;  ///< 1.5 times as large: what the grid covers and random points fill

  bool has_triangles() const { return facets.front().facet.corner_count == 3; }
};

/// Names of all inputs of a run, in the order in which they are measured.
std::vector<std::string> input_names(bool quick);

/// Makes the input; Error for a name that is none. "sphere_2e5" has about 200,000 facets.
Input make_input(const std::string& name);

}  // namespace meshgrow::kernels

#endif
