#include "grid_nodes.h"

#include "error.h"

namespace meshgrow {

namespace {

constexpr int max_table_depth = 5;

void fill(const std::vector<GridBlock>& blocks, GridNodeCode node, int depth, std::uint32_t x,
          std::uint32_t y, std::uint32_t z, GridTable& table) {
  if (kind_of(node) == GridNodeKind::block && depth < table.depth) {
    for (std::uint32_t i = 0; i < 8; ++i) {
      fill(blocks, blocks[index_of(node)][i], depth + 1, 2 * x + (i & 1), 2 * y + (i >> 1 & 1),
           2 * z + (i >> 2), table);
    }
    return;
  }
  const int below = table.depth - depth;
  for (std::uint32_t i = 0; i < 1u << 3 * below; ++i) {
    const std::uint32_t mask = (1u << below) - 1;
    const std::uint32_t column = (x << below) + (i & mask);
    const std::uint32_t row = (y << below) + (i >> below & mask);
    const std::uint32_t layer = (z << below) + (i >> 2 * below);
    table.entries[(layer << 2 * table.depth) + (row << table.depth) + column] = {
        node, static_cast<std::uint32_t>(depth)};
  }
}

}  // namespace

GridNodeCode grid_node(GridNodeKind kind, std::size_t index) {
  if (index > 0x3FFFFFFFu) {
    throw Error("The background grid has over a billion cells: raise its tolerance.");
  }
  return static_cast<GridNodeCode>(kind) << 30 | static_cast<GridNodeCode>(index);
}

GridTable make_grid_table(const std::vector<GridBlock>& blocks) {
  GridTable table;
  // No more entries than there are blocks, give or take: small grids have small tables.
  while (table.depth < max_table_depth && (std::size_t{1} << 3 * table.depth) < blocks.size()) {
    ++table.depth;
  }
  table.entries.resize(std::size_t{1} << 3 * table.depth);
  fill(blocks, blocks[0][0], 0, 0, 0, 0, table);
  return table;
}

}  // namespace meshgrow
