#ifndef MESHGROW_SIMD_TREE_KERNELS_H
#define MESHGROW_SIMD_TREE_KERNELS_H

#include <cstdint>

#include "wide_tree.h"

namespace meshgrow::simd {

/// The facets that may give the least size S0 + α · distance at a place. Float only rules others
/// out, with its rounding allowed for: who asks decides among the candidates in double.
struct LeastSize {
  static constexpr int capacity = 32;

  double place[3];
  const NodeEntry* entries;  ///< where to look
  int entry_count;
  float limit;  ///< in: nothing above it is wanted; out: nothing above it can be the least
  int count = 0;
  std::uint32_t facets[capacity];
  float lower_bounds[capacity];  ///< of their sizes
  /// Called when there are more candidates than fit; takes them all and may lower the limit.
  void (*overflow)(LeastSize& query) = nullptr;
  void* context = nullptr;
};

/// A cell and a number for each of its corners, as reciprocals. The ratio of a facet is the least,
/// over the corners, of tangent plane · reciprocal. The tangent plane of S0 + α · distance at the
/// cell's centre is a lower bound of it everywhere, and so is that of a box around the facet: the
/// larger of their ratios counts. In the whole cell the facet's size is at least its ratio times
/// what the numbers give by trilinear interpolation.
struct CellCorners {
  double centre[3];
  float half_edge;
  float reciprocals[8];
};

/// Looks for the facet of the least ratio.
struct LeastRatio {
  CellCorners cell;
  float ratio;   ///< in: ratios from here on do not matter; out: a lower bound of all
  float enough;  ///< a ratio below it ends the search, with `ratio` below it as well
};

/// Collects the children that have ratios below 1.
struct Survivors {
  CellCorners cell;
  float largest;              ///< S0 + α · distance below which a facet may survive
  float open_edge;            ///< nodes with an edge longer than it are opened
  bool open_blocks;           ///< look at the facets of blocks one by one
  std::uint32_t most_facets;  ///< more surviving facets (in open blocks) end the search
  NodeEntry* entries;         ///< out
  int capacity;
  int count;             ///< out
  std::uint32_t facets;  ///< out: survivors of open blocks
};

struct TreeKernels {
  const char* name;
  /// Several places at once take less time each.
  void (*least_sizes)(const WideTree&, LeastSize* queries, int count);
  void (*least_ratio)(const WideTree&, const NodeEntry* entries, int count, LeastRatio&);
  /// Upper bounds of the sizes that a facet of the block gives at the corners of the cell.
  void (*corner_sizes)(const FacetBlock&, int lane, const CellCorners&, float* sizes);
  /// False if there is no room for all or there are too many facets.
  bool (*survivors)(const WideTree&, const NodeEntry* entries, int count, Survivors&);
};

/// The fastest that this processor runs; MESHGROW_SIMD=plain, avx2 or avx512 asks for another.
const TreeKernels& tree_kernels();

/// By name; null where the processor or the build has none such.
const TreeKernels* tree_kernels(const char* name);

}  // namespace meshgrow::simd

#endif
