#ifndef MESHGROW_BENCHMARKS_KERNELS_CGAL_PEER_H
#define MESHGROW_BENCHMARKS_KERNELS_CGAL_PEER_H

#include <cstddef>
#include <memory>

#include "sized_facets.h"

namespace meshgrow::kernels {

/// Squared distances by CGAL's AABB tree with its tree of hints.
class CgalPeer {
 public:
  /// Takes over triangles or segments, all of one kind, in CGAL's form. Builds nothing yet.
  explicit CgalPeer(const SizedFacets& facets);
  ~CgalPeer();

  /// What is timed as CGAL's building: the boxes and the tree of hints. Replaces what was built.
  void build();

  /// Frees what build() made.
  void clear();

  void squared_distances(const Vec3* points, std::size_t count, double* squared) const;

 private:
  class Tree;
  template <typename Datum, typename Primitive>
  class TreeOf;

  std::unique_ptr<Tree> tree_;
};

}  // namespace meshgrow::kernels

#endif
