#ifndef MESHGROW_BENCHMARKS_KERNELS_GRID_KERNELS_H
#define MESHGROW_BENCHMARKS_KERNELS_GRID_KERNELS_H

#include "background_grid.h"
#include "checks.h"
#include "inputs.h"
#include "options.h"
#include "results.h"

namespace meshgrow::kernels {

bool wants_grid_kernels(const Options& options);

/// grid.max_over, grid.p999_under and grid.eval.*: how good and how fast the grid's sizes are.
void measure_grid_kernels(const Input& input, const BackgroundGrid& grid, const Options& options,
                          Results& results, Checks& checks);

}  // namespace meshgrow::kernels

#endif
