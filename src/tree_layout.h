#ifndef MESHGROW_TREE_LAYOUT_H
#define MESHGROW_TREE_LAYOUT_H

#include <cstdint>
#include <vector>

#include "simd/wide_tree.h"
#include "sized_facets.h"
#include "stored_array.h"

namespace meshgrow {

/// Boxes of the children of a node, enlarged a little; in the units of the nodes.
struct WideBoxes {
  float lower[3][simd::lanes];
  float upper[3][simd::lanes];
};

/// The nodes and blocks of a FacetTree, and the order of facets that goes with them: those of a
/// block are adjacent. Every node but those along one edge of the tree has eight children, every
/// block but the last eight facets.
struct TreeLayout {
  Box box;                     ///< of all facets, model units
  Vec3 centre = Vec3::Zero();  ///< origin of the nodes' and blocks' coordinates, model units
  double unit = 1.0;           ///< of the nodes' and blocks' lengths and sizes, in model units
  std::vector<std::uint32_t> order;  ///< original index of each facet
  std::vector<simd::WideNode> nodes;
  std::vector<WideBoxes> boxes;  ///< of each node
  std::vector<float> slopes;     ///< smallest below each node
  std::vector<simd::FacetBlock> blocks;
  std::vector<simd::NodeEntry> block_entries;  ///< where each block hangs
};

/// A tree as it is searched, in memory or in a file.
struct StoredTree {
  Box box;
  Vec3 centre = Vec3::Zero();
  double unit = 1.0;
  double largest_slope = 0.0;
  StoredArray<SizedFacet> facets;  ///< in the order of the tree
  StoredArray<std::uint32_t> order;
  StoredArray<simd::WideNode> nodes;
  StoredArray<WideBoxes> boxes;
  StoredArray<float> slopes;
  StoredArray<simd::FacetBlock> blocks;
  StoredArray<simd::NodeEntry> block_entries;
};

/// Brings the facets into order as well. The same for any number of threads (0: as many as
/// `parallel_for` takes).
TreeLayout layout_tree(SizedFacets& facets, int threads);

}  // namespace meshgrow

#endif
