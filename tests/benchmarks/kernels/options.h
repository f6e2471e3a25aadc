#ifndef MESHGROW_BENCHMARKS_KERNELS_OPTIONS_H
#define MESHGROW_BENCHMARKS_KERNELS_OPTIONS_H

#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

namespace meshgrow::kernels {

struct Options {
  bool quick = false;
  std::vector<std::string> only;  ///< prefixes of the numbers' names; empty: all
  std::vector<std::string> inputs;
  int repetitions = 5;
  std::string json;              ///< file to merge the results into; empty: none
  std::string peak_of;           ///< hidden: the child process of scale.peak_gib_1e7
  std::size_t query_count = 0;   ///< exact queries in one timing
  std::size_t eval_count = 0;    ///< grid evaluations in one timing
  std::size_t sample_count = 0;  ///< points at which the grid is compared with exact sizes

  bool wants(const std::string& name) const;
  bool wants_any(std::initializer_list<const char*> names) const;
};

/// Error with a text for the user where an argument is wrong.
Options parse_options(int argc, char** argv);

std::string usage();

}  // namespace meshgrow::kernels

#endif
