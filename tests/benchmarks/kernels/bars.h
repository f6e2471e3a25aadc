#ifndef MESHGROW_BENCHMARKS_KERNELS_BARS_H
#define MESHGROW_BENCHMARKS_KERNELS_BARS_H

#include <optional>

#include "results.h"

namespace meshgrow::kernels {

/// What a number should reach. Shown beside it; times never decide the exit status.
struct Bar {
  double value;
  bool at_least;  ///< else at most

  bool met_by(double number) const { return at_least ? number >= value : number <= value; }
};

/// None for numbers that are only for the reader.
std::optional<Bar> bar_of(const Path& path);

}  // namespace meshgrow::kernels

#endif
