#ifndef MESHGROW_BENCHMARKS_KERNELS_CHECKS_H
#define MESHGROW_BENCHMARKS_KERNELS_CHECKS_H

#include <string>
#include <vector>

#include "cgal_peer.h"
#include "facet_tree.h"
#include "inputs.h"

namespace meshgrow::kernels {

/// Wrong answers make the exit status 1, whatever the times are.
class Checks {
 public:
  /// An answer at one point beside the one that was expected.
  struct Answer {
    const char* what;
    unsigned seed;
    Vec3 point;
    double got;
    double expected;

    double relative_error() const;
  };

  /// Prints the answer as wrong and remembers it.
  void fail(const Input& input, const Answer& answer);

  bool passed() const { return failures_ == 0; }

 private:
  int failures_ = 0;
};

/// Single and batch answers of the tree at random points against all facets one by one.
void check_exact_sizes(const Input& input, const FacetTree& tree, Checks& checks);

/// Whether a peer's distances are right, within an error relative to the input's extent: the time
/// of a peer that answers another question says nothing.
void check_peer(const Input& input, const char* peer, double allowed_error,
                const std::vector<Vec3>& points, const std::vector<double>& distances,
                Checks& checks);

}  // namespace meshgrow::kernels

#endif
