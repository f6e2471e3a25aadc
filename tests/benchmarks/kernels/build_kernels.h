#ifndef MESHGROW_BENCHMARKS_KERNELS_BUILD_KERNELS_H
#define MESHGROW_BENCHMARKS_KERNELS_BUILD_KERNELS_H

#include <memory>

#include "background_grid.h"
#include "cgal_peer.h"
#include "inputs.h"
#include "options.h"
#include "results.h"

namespace meshgrow::kernels {

struct Built {
  std::shared_ptr<const FacetTree> tree;
  std::unique_ptr<const BackgroundGrid> grid;
};

/// Builds our tree without timing it.
std::shared_ptr<const FacetTree> build_tree(const Input& input, int threads);

std::unique_ptr<const BackgroundGrid> build_grid(const Input& input,
                                                 std::shared_ptr<const FacetTree> tree,
                                                 int threads);

bool wants_build_kernels(const Options& options);

/// tree.*, grid.build.* and the grid's memory. Leaves the peer's tree built, and returns ours of
/// the last repetition; without a grid where none was built.
Built measure_build_kernels(const Input& input, CgalPeer& cgal, const Options& options,
                            Results& results);

}  // namespace meshgrow::kernels

#endif
