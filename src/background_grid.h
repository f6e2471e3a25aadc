#ifndef MESHGROW_BACKGROUND_GRID_H
#define MESHGROW_BACKGROUND_GRID_H

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "attached_region.h"
#include "facet_tree.h"
#include "grid_cell.h"

namespace meshgrow {

struct GridOptions {
  /// Relative tolerance t: the grid's size is at most (1 + t) times the exact one, everywhere.
  double tolerance = 0.05;
  /// OpenMP threads that build; 0: OMP_NUM_THREADS, else all processors. The result does not depend
  /// on it.
  int threads = 0;
  /// A cell with at most so many facets left may keep them and answer from them.
  int facets_per_exact_leaf = 192;
  /// Where sizes will be asked for; everywhere if null. Cells outside are not refined: points in
  /// them are answered by the tree.
  std::shared_ptr<const AttachedRegion> region;
  /// Called with the finished fraction in [0, 1], from the calling thread only.
  std::function<void(double)> progress;
};

/// Throws Error unless a background grid can have this relative tolerance: 0.0001 to 1.
void check_tolerance(double tolerance);

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

  /// Size at the finite point p in model units: from the grid inside its cube, exact outside.
  double size(const Vec3& p) const;

  /// The same; tells whether the answer was interpolated (true) or searched for in the tree.
  double size(const Vec3& p, bool& interpolated) const;

  /// The same for many points, which wait for memory together and not one after the other.
  /// Returns how many were interpolated.
  std::size_t sizes(const Vec3* points, std::size_t count, double* sizes) const;

  struct Statistics {
    std::size_t interpolated_leaves = 0;
    std::size_t exact_leaves = 0;
    std::size_t blocks = 0;  ///< inner nodes, eight children each
    int depth = 0;
    std::size_t bytes = 0;  ///< without the tree
    double seconds = 0.0;   ///< wall time of building
  };
  const Statistics& statistics() const { return statistics_; }

  const FacetTree& tree() const { return *tree_; }
  double size_limit() const { return size_limit_; }
  Box cube() const { return Box(cube_.origin, cube_.origin + Vec3::Constant(cube_.edge)); }

 private:
  friend class GridBuilder;

  using CornerValues = std::array<float, 8>;

  /// Two bits of kind above 30 bits of index.
  using NodeCode = std::uint32_t;
  enum class NodeKind : std::uint32_t { block = 0, interpolated = 1, exact = 2, tree = 3 };

  /// The nodes of one subtree; the codes index into the same part.
  struct Nodes {
    std::vector<std::array<NodeCode, 8>> blocks;
    std::vector<CornerValues> corners;
    std::vector<std::uint32_t> exact_begin;      ///< one more than exact leaves
    std::vector<simd::NodeEntry> exact_entries;  ///< parts of the tree
    int depth = 0;
  };

  static NodeCode code(NodeKind kind, std::size_t index);
  static NodeKind kind(NodeCode code) { return static_cast<NodeKind>(code >> 30); }
  static std::uint32_t index(NodeCode code) { return code & 0x3FFFFFFFu; }

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
  void fill_table();
  void fill_table(NodeCode node, int depth, std::uint32_t x, std::uint32_t y, std::uint32_t z);

  std::shared_ptr<const FacetTree> tree_;
  double size_limit_;
  GridCube cube_;
  double steps_per_unit_ = 0.0;
  Nodes nodes_;
  /// The nodes of one depth, or the leaves above it, side by side: spares the way down to them.
  struct TableEntry {
    NodeCode node;
    std::uint32_t depth;
  };
  std::vector<TableEntry> table_;
  int table_depth_ = 0;
  Statistics statistics_;
};

}  // namespace meshgrow

#endif
