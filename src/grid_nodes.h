#ifndef MESHGROW_GRID_NODES_H
#define MESHGROW_GRID_NODES_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "grid_cell.h"
#include "simd/wide_tree.h"
#include "stored_array.h"

namespace meshgrow {

/// A node of the octree of a background grid: two bits of kind above 30 bits of index.
using GridNodeCode = std::uint32_t;
enum class GridNodeKind : std::uint32_t {
  block = 0,         ///< eight children
  interpolated = 1,  ///< a leaf with corner values
  exact = 2,         ///< a leaf that keeps parts of the tree of facets
  tree = 3           ///< a leaf that asks the whole tree
};

using GridBlock = std::array<GridNodeCode, 8>;
using GridCorners = std::array<float, 8>;

/// Throws Error if the index is too large.
GridNodeCode grid_node(GridNodeKind kind, std::size_t index);
inline GridNodeKind kind_of(GridNodeCode code) { return static_cast<GridNodeKind>(code >> 30); }
inline std::uint32_t index_of(GridNodeCode code) { return code & 0x3FFFFFFFu; }

/// The nodes of an octree, or of one subtree of it; the codes index into the same part. Children
/// stand after their parents.
struct GridNodes {
  std::vector<GridBlock> blocks;
  std::vector<GridCorners> corners;
  std::vector<std::uint32_t> exact_begin;      ///< one more than exact leaves
  std::vector<simd::NodeEntry> exact_entries;  ///< parts of the tree
  int depth = 0;
  /// Of cells that were not refined further, though they should: the relative tolerance that
  /// interpolating between exact sizes at their corners would have there.
  double undecided_tolerance = 0.0;
};

/// The nodes of one depth, or the leaves above it, side by side: spares the way down to them.
struct GridTable {
  struct Entry {
    GridNodeCode node;
    std::uint32_t depth;
  };
  std::vector<Entry> entries;  ///< along x, then y, then z
  int depth = 0;
};
GridTable make_grid_table(const std::vector<GridBlock>& blocks);

struct GridStatistics {
  std::size_t interpolated_leaves = 0;
  std::size_t exact_leaves = 0;
  std::size_t blocks = 0;  ///< inner nodes, eight children each
  int depth = 0;
  std::size_t bytes = 0;  ///< without the tree
  double seconds = 0.0;   ///< wall time of building
  // Not stored in files:
  std::size_t max_cells = 0;  ///< that it was allowed
  bool is_limited = false;    ///< it would have more, if it were allowed
  /// Relative, of a grid in which every cell is interpolated; what the tree answers is exact.
  double tolerance = 0.0;
};

/// A grid as it is asked, in memory or in a file. Block 0 stands above the root: its first child is
/// the root.
struct StoredGrid {
  double size_limit = 0.0;
  GridCube cube;
  StoredArray<GridBlock> blocks;
  StoredArray<GridCorners> corners;
  StoredArray<std::uint32_t> exact_begin;
  StoredArray<simd::NodeEntry> exact_entries;
  StoredArray<GridTable::Entry> table;
  int table_depth = 0;
  GridStatistics statistics;
};

}  // namespace meshgrow

#endif
