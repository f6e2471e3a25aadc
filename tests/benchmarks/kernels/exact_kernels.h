#ifndef MESHGROW_BENCHMARKS_KERNELS_EXACT_KERNELS_H
#define MESHGROW_BENCHMARKS_KERNELS_EXACT_KERNELS_H

#include "cgal_peer.h"
#include "checks.h"
#include "facet_tree.h"
#include "inputs.h"
#include "options.h"
#include "results.h"

namespace meshgrow::kernels {

bool wants_exact_kernels(const Options& options);

/// exact.*: exact sizes against the closest-point queries of CGAL and Embree, one thread. Both
/// trees are built.
void measure_exact_kernels(const Input& input, const FacetTree& tree, const CgalPeer& cgal,
                           const Options& options, Results& results, Checks& checks);

}  // namespace meshgrow::kernels

#endif
