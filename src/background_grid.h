#ifndef MESHGROW_BACKGROUND_GRID_H
#define MESHGROW_BACKGROUND_GRID_H

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "attached_region.h"
#include "facet_tree.h"
#include "grid_nodes.h"

namespace meshgrow {

struct GridOptions {
  /// Relative tolerance t: the grid's size is at most (1 + t) times the exact one, everywhere.
  double tolerance = 0.05;
  /// OpenMP threads that build; 0: OMP_NUM_THREADS, else all processors. The result does not depend
  /// on it.
  int threads = 0;
  /// A cell with at most so many facets left may keep them and answer from them.
  int facets_per_exact_leaf = 192;
  /// Most cells, of 40 bytes each; one that keeps many facets counts as several. 0: as many as half
  /// of the memory that is available holds while they are built. What a grid of so many cells
  /// cannot refine is answered by the tree: exactly, but slower.
  std::size_t max_cells = 0;
  /// Where sizes will be asked for; everywhere if null. Cells outside are not refined: points in
  /// them are answered by the tree.
  std::shared_ptr<const AttachedRegion> region;
  /// Called with the finished fraction in [0, 1], from the calling thread only.
  std::function<void(double)> progress;
};

/// Throws Error unless a background grid can have this relative tolerance: 0.0001 to 1.
void check_tolerance(double tolerance);

/// Throws Error unless so many cells can be the most of a background grid: 0, or 8 to 400 million.
void check_max_cells(double cells);

/// A leaf of a background grid, as BackgroundGrid::for_each_leaf tells it.
struct GridLeaf {
  LatticePlace lowest;
  int depth = 0;  ///< its edge is that of the cube divided by 2^depth
  /// Sizes at its corners, in the order of GridCell's, to be interpolated; null if facets answer.
  const std::array<float, 8>* sizes = nullptr;
  /// Whether it keeps facets that answer. If not, and nothing is interpolated, the whole tree does:
  /// in cells outside of where sizes will be asked for, and in the smallest there are.
  bool keeps_facets = false;
};

/// Octree that interpolates a size field (paper, section 4; DESIGN.md, section 2).
///
/// The field is h(p) = min(L, min over facets of S0 + α · distance). The grid promises
/// `size(p) ≤ (1 + t) h(p)` at every point p, by proof and not by sampling (cell_classifier.h).
/// Beside the source, where facets have no tangent planes that help, a cell keeps the parts of the
/// tree that hold the few facets which can rule in it, and answers from them. That the grid is not
/// much *smaller* than h is proven by one facet, or checked at 19 points of the cell.
///
/// Immutable after construction; every const function may be called from any thread.
class BackgroundGrid {
 public:
  /// Builds in parallel. `box` (model units) is enlarged to a cube; a flat or empty one is allowed.
  BackgroundGrid(std::shared_ptr<const FacetTree> tree, double size_limit, const Box& box,
                 const GridOptions& options = {});

  /// Takes over what another grid over an equal tree has stored.
  BackgroundGrid(std::shared_ptr<const FacetTree> tree, StoredGrid stored);
  const StoredGrid& stored() const { return stored_; }

  /// Size at the finite point p in model units: from the grid inside its cube, exact outside.
  double size(const Vec3& p) const;

  /// The same; tells whether the answer was interpolated (true) or searched for in the tree.
  double size(const Vec3& p, bool& interpolated) const;

  /// The same for many points, which wait for memory together and not one after the other.
  /// Returns how many were interpolated.
  std::size_t sizes(const Vec3* points, std::size_t count, double* sizes) const;

  /// Calls `visit` for every leaf. Together they fill the cube; the lattice is that of
  /// `grid_cube()`.
  void for_each_leaf(const std::function<void(const GridLeaf&)>& visit) const;
  const GridCube& grid_cube() const { return stored_.cube; }

  using Statistics = GridStatistics;
  const Statistics& statistics() const { return stored_.statistics; }

  const FacetTree& tree() const { return *tree_; }
  double size_limit() const { return stored_.size_limit; }
  Box cube() const {
    return Box(stored_.cube.origin, stored_.cube.origin + Vec3::Constant(stored_.cube.edge));
  }

 private:
  using NodeCode = GridNodeCode;
  using NodeKind = GridNodeKind;

  /// Where a point is: the leaf, and the place in it.
  struct Spot {
    NodeCode node;
    int depth;
    std::array<std::uint32_t, 3> steps;  ///< of the finest lattice, from the cube's lowest corner
    Vec3 place;                          ///< the same as a number with a fraction
  };

  bool find_in_table(const Vec3& p, Spot& spot) const;
  NodeCode child(const Spot& spot) const;
  double leaf_size(const Spot& spot, const Vec3& p) const;
  FacetTree::Entries exact_entries(NodeCode leaf) const;
  void set_steps();
  /// No built grid has cells beyond the greatest depth, but a file may say so.
  [[noreturn]] static void fail_too_deep();

  std::shared_ptr<const FacetTree> tree_;
  StoredGrid stored_;
  double steps_per_unit_ = 0.0;
};

}  // namespace meshgrow

#endif
