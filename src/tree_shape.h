#ifndef MESHGROW_TREE_SHAPE_H
#define MESHGROW_TREE_SHAPE_H

#include <array>
#include <cstdint>

#include "simd/wide_tree.h"

namespace meshgrow {

// The shape of a FacetTree follows from the number of its blocks alone: all children of a node but
// the last are full subtrees, and a node stands before those below it. Thread-safe.

/// Blocks below each child but the last of a node with so many blocks: a power of eight.
std::uint32_t blocks_per_child(std::uint32_t blocks);

/// Nodes of a subtree with so many blocks (one at least), itself included.
std::uint32_t nodes_for(std::uint32_t blocks);

struct NodeChildren {
  int count = 0;
  std::array<std::uint32_t, simd::lanes> codes{};  ///< as in WideNode::child
};

/// Of a node, below nodes_for(blocks), of the tree with so many blocks.
NodeChildren children_of(std::uint32_t node, std::uint32_t blocks);

}  // namespace meshgrow

#endif
