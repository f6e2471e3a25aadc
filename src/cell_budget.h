#ifndef MESHGROW_CELL_BUDGET_H
#define MESHGROW_CELL_BUDGET_H

#include <atomic>
#include <cstddef>

namespace meshgrow {

/// Counts the cells of a background grid while several threads build it, so that they stop before
/// memory is full. Whether the cells of a whole grid are too many depends on no order.
class CellBudget {
 public:
  /// Thrown by `spend`.
  struct Exceeded {};

  explicit CellBudget(std::size_t most) : most_(most) {}

  /// Throws Exceeded if that makes more than there may be. Thread-safe.
  void spend(std::size_t cells) {
    if (spent_.fetch_add(cells, std::memory_order_relaxed) + cells > most_) {
      throw Exceeded();
    }
  }

 private:
  std::size_t most_;
  std::atomic<std::size_t> spent_{0};
};

/// Most cells of a grid where nobody says: while it is built it then takes no more than half of the
/// memory that is available.
std::size_t default_max_cells();

/// So many cells, and what they keep of the tree, can be told apart by numbers of 30 and 32 bits.
constexpr std::size_t most_cells_of_all = 400000000;

/// Memory of a cell: corner values, its code, and its share of the blocks. Entries of the tree that
/// a cell keeps count as so many more cells as they need the memory of.
constexpr std::size_t bytes_per_cell = 40;

}  // namespace meshgrow

#endif
