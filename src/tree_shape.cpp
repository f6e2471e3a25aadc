#include "tree_shape.h"

#include <algorithm>

namespace meshgrow {

std::uint32_t blocks_per_child(std::uint32_t blocks) {
  std::uint32_t capacity = 1;
  while (static_cast<std::uint64_t>(capacity) * simd::lanes < blocks) {
    capacity *= simd::lanes;
  }
  return capacity;
}

std::uint32_t nodes_for(std::uint32_t blocks) {
  const std::uint32_t capacity = blocks_per_child(blocks);
  if (capacity == 1) {
    return 1;
  }
  const std::uint32_t rest = blocks % capacity;
  return 1 + blocks / capacity * nodes_for(capacity) + (rest > 1 ? nodes_for(rest) : 0);
}

NodeChildren children_of(std::uint32_t node, std::uint32_t blocks) {
  std::uint32_t at = 0;
  std::uint32_t first_block = 0;
  std::uint32_t capacity = blocks_per_child(blocks);
  while (at != node) {
    // Down to the child that the node is in.
    const std::uint32_t nodes_of_full = nodes_for(capacity);
    const std::uint32_t child = std::min((node - at - 1) / nodes_of_full, (blocks - 1) / capacity);
    at += 1 + child * nodes_of_full;
    first_block += child * capacity;
    blocks = std::min(capacity, blocks - child * capacity);
    capacity = blocks_per_child(blocks);
  }
  NodeChildren result;
  for (std::uint32_t done = 0, below = at + 1; done < blocks; done += capacity) {
    const std::uint32_t part = std::min(capacity, blocks - done);
    result.codes[static_cast<std::size_t>(result.count++)] =
        part == 1 ? (first_block + done) | simd::WideNode::is_block : below;
    below += part == 1 ? 0 : nodes_for(part);
  }
  return result;
}

}  // namespace meshgrow
