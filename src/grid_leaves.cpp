#include "background_grid.h"

namespace meshgrow {

void BackgroundGrid::for_each_leaf(const std::function<void(const GridLeaf&)>& visit) const {
  struct Open {
    NodeCode node;
    GridLeaf leaf;
  };
  std::vector<Open> open = {{stored_.blocks[0][0], {}}};
  std::size_t blocks_seen = 0;
  while (!open.empty()) {
    Open next = open.back();
    open.pop_back();
    if (kind_of(next.node) != NodeKind::block) {
      if (kind_of(next.node) == NodeKind::interpolated) {
        next.leaf.sizes = &stored_.corners[index_of(next.node)];
      }
      next.leaf.keeps_facets = kind_of(next.node) == NodeKind::exact;
      visit(next.leaf);
      continue;
    }
    if (next.leaf.depth >= max_grid_depth || ++blocks_seen >= stored_.blocks.size()) {
      fail_too_deep();
    }
    const std::uint32_t half = 1u << (max_grid_depth - next.leaf.depth - 1);
    for (std::uint32_t i = 8; i-- > 0;) {
      const LatticePlace& lowest = next.leaf.lowest;
      const LatticePlace place = {lowest.x + (i & 1 ? half : 0), lowest.y + (i & 2 ? half : 0),
                                  lowest.z + (i & 4 ? half : 0)};
      open.push_back({stored_.blocks[index_of(next.node)][i], {place, next.leaf.depth + 1}});
    }
  }
}

}  // namespace meshgrow
