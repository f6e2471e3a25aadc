#ifndef MESHGROW_SIMD_WIDE_TREE_H
#define MESHGROW_SIMD_WIDE_TREE_H

#include <cstdint>

namespace meshgrow::simd {

// What the kernels work on: plain data in float, eight children or facets side by side. Lengths and
// sizes are in units of the tree's box, places relative to its centre.

constexpr int lanes = 8;

/// Eight children of a node of the tree.
struct alignas(64) WideNode {
  static constexpr std::uint32_t is_block = 0x80000000u;

  // Around what is below each child there is a box that lies as its contents. It is enlarged by
  // the rounding of a place to float. The third axis is the cross product of the others.
  float centre[3][lanes];
  float first_axis[3][lanes];
  float second_axis[3][lanes];
  float half_sizes[3][lanes];  ///< along the axes
  float start_size[lanes];     ///< smallest below the child; infinite where there is none
  std::uint32_t child[lanes];  ///< index of a node, or of a block with the bit is_block
};
static_assert(sizeof(WideNode) == 448, "seven cache lines");

/// Eight facets, each in a frame of its own: the first corner is the origin, the longest side runs
/// along x to (length, 0), the third corner stands above it at (foot, height). A segment has no
/// height, a point no length either.
struct alignas(64) FacetBlock {
  float corner[3][lanes];  ///< relative to the block's origin
  float along[3][lanes];   ///< unit vector along the longest side
  float across[3][lanes];  ///< unit vector in the facet's plane towards the third corner
  float length[lanes];
  float foot[lanes];
  float height[lanes];
  float start_size[lanes];  ///< infinite where there is no facet
  float slope[lanes];
  double origin[3];
  float place_error;    ///< bound of the rounding of corners and of places near the block
  std::uint32_t first;  ///< index of the first facet
  std::uint32_t count;  ///< of facets
  std::uint32_t unused;
};
static_assert(sizeof(FacetBlock) == 512, "eight cache lines");

/// Some children of a node: its index above eight bits, one a child.
using NodeEntry = std::uint32_t;
constexpr NodeEntry all_children = 0xFFu;
constexpr std::uint32_t max_nodes = 1u << 24;

struct WideTree {
  const WideNode* nodes = nullptr;
  const float* slopes = nullptr;  ///< smallest below each node
  const FacetBlock* blocks = nullptr;
  /// Called before the first use of a node or block, unless null; may throw.
  void (*touch_node)(const void* owner, std::uint32_t node) = nullptr;
  void (*touch_block)(const void* owner, std::uint32_t block) = nullptr;
  const void* owner = nullptr;
};

}  // namespace meshgrow::simd

#endif
