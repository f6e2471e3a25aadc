#ifndef MESHGROW_FACET_TREE_H
#define MESHGROW_FACET_TREE_H

#include <cstdint>
#include <limits>
#include <vector>

#include "sized_facets.h"

namespace meshgrow {

/// Bounding volume hierarchy over sized facets. Each node carries the smallest start size and the
/// smallest slope below it, so a best-first descent finds the exact minimum of S0 + α · distance
/// over
/// **all** facets, not only over the nearest one (DESIGN.md, section 2).
///
/// Immutable after construction; every const function may be called from any thread.
class FacetTree {
 public:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// Takes the facets over and reorders them. An empty set is allowed: every size is then infinite.
  explicit FacetTree(SizedFacets facets);

  /// Minimum over all facets of S0 + α · distance(p), or `upper_bound` where no facet is below it.
  /// p must be finite; model units.
  double size(const Vec3& p, double upper_bound = infinity) const;

  struct Closest {
    std::size_t facet = 0;       ///< index into facets()
    double distance = infinity;  ///< model units; infinite when the tree is empty
  };

  /// The facet nearest to the finite point p, whatever its start size.
  Closest closest_facet(const Vec3& p) const;

  /// The facets in the tree's own order, neighbours in space near each other.
  const SizedFacets& facets() const { return facets_; }

  bool empty() const { return facets_.empty(); }
  std::size_t memory_bytes() const;

 private:
  struct Node {
    Box box;
    double min_start_size;
    double min_slope;
    std::uint32_t
        first;  ///< first facet of a leaf, else index of the first of two adjacent children
    std::uint32_t count;  ///< facets of a leaf, 0 for an inner node
  };

  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);

  template <typename LowerBound, typename FacetValue>
  Closest best_first(double upper_bound, LowerBound lower_bound, FacetValue value) const;

  SizedFacets facets_;
  std::vector<Node> nodes_;
};

}  // namespace meshgrow

#endif
