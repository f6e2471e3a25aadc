#include "cell_budget.h"

#include <algorithm>

#include "available_memory.h"

namespace meshgrow {

namespace {

/// While it is built: arrays that double as they grow, and are then joined into one.
constexpr std::size_t times_while_building = 4;

constexpr std::size_t share_of_memory = 2;

constexpr std::size_t fewest = 1000;

}  // namespace

std::size_t default_max_cells() {
  const std::size_t cells =
      available_memory() / (share_of_memory * times_while_building * bytes_per_cell);
  return std::clamp(cells, fewest, most_cells_of_all);
}

}  // namespace meshgrow
