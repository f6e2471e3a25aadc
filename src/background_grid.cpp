#include "background_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cell_budget.h"
#include "error.h"
#include "grid_builder.h"
#include "grid_cell.h"
#include "number_text.h"
#include "stop_watch.h"

namespace meshgrow {

namespace {

constexpr double smallest_tolerance = 1e-4;

constexpr double fewest_max_cells = 8.0;

constexpr std::uint32_t last_step = (1u << max_grid_depth) - 1;

void check(const GridOptions& options) {
  check_tolerance(options.tolerance);
  check_max_cells(static_cast<double>(options.max_cells));
  if (options.facets_per_exact_leaf < 0) {
    throw Error("A cell of the background grid must be allowed 0 facets or more, not " +
                std::to_string(options.facets_per_exact_leaf) + ".");
  }
}

}  // namespace

void check_tolerance(double tolerance) {
  if (!(tolerance >= smallest_tolerance && tolerance <= 1.0)) {
    throw Error("The tolerance of the background grid is " + shortest(tolerance) +
                ": give a number from 0.0001 to 1, for example 0.05.");
  }
}

void check_max_cells(double cells) {
  if (cells != 0.0 &&
      !(cells >= fewest_max_cells && cells <= static_cast<double>(most_cells_of_all))) {
    throw Error(
        "The background grid may have at most " + shortest(cells) +
        " cells: give a number from 8 to 400 million, or 0 for as many as fit into memory.");
  }
}

BackgroundGrid::BackgroundGrid(std::shared_ptr<const FacetTree> tree, double size_limit,
                               const Box& box, const GridOptions& options)
    : tree_(std::move(tree)) {
  check(options);
  const StopWatch watch;
  stored_.size_limit = size_limit;
  if (!box.isEmpty()) {
    // A hair larger, so that points on the box's own faces are inside in spite of rounding.
    const double reach = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
    const double margin = 1e-9 * box.sizes().maxCoeff() + 1e-12 * reach;
    stored_.cube.origin = box.min() - Vec3::Constant(margin);
    stored_.cube.edge = box.sizes().maxCoeff() + 2.0 * margin;
  }
  set_steps();
  GridBuilder builder(*tree_, stored_.cube, size_limit, options);
  GridNodes nodes = builder.build();
  GridTable table = make_grid_table(nodes.blocks);
  stored_.blocks = std::move(nodes.blocks);
  stored_.corners = std::move(nodes.corners);
  stored_.exact_begin = std::move(nodes.exact_begin);
  stored_.exact_entries = std::move(nodes.exact_entries);
  stored_.table = std::move(table.entries);
  stored_.table_depth = table.depth;
  GridStatistics& statistics = stored_.statistics;
  statistics.seconds = watch.seconds();
  statistics.interpolated_leaves = stored_.corners.size();
  statistics.exact_leaves = stored_.exact_begin.size() - 1;
  statistics.blocks = stored_.blocks.size() - 1;  // one stands above the root
  statistics.depth = nodes.depth;
  statistics.max_cells = builder.max_cells();
  statistics.is_limited = builder.is_limited();
  statistics.tolerance = std::max(options.tolerance, nodes.undecided_tolerance);
  statistics.bytes = stored_.blocks.bytes() + stored_.corners.bytes() +
                     stored_.exact_begin.bytes() + stored_.exact_entries.bytes() +
                     stored_.table.bytes();
}

BackgroundGrid::BackgroundGrid(std::shared_ptr<const FacetTree> tree, StoredGrid stored)
    : tree_(std::move(tree)), stored_(std::move(stored)) {
  set_steps();
}

void BackgroundGrid::set_steps() {
  // In a cube of next to no extent all places are the same.
  const double step = stored_.cube.step();
  steps_per_unit_ = step > std::numeric_limits<double>::min() ? 1.0 / step : 0.0;
}

// ==== Evaluation

bool BackgroundGrid::find_in_table(const Vec3& p, Spot& spot) const {
  const Vec3 local = p - stored_.cube.origin;
  if (!((local.array() >= 0.0).all() && (local.array() < stored_.cube.edge).all())) {
    return false;
  }
  spot.place = local * steps_per_unit_;
  std::size_t entry = 0;
  for (int axis = 2; axis >= 0; --axis) {
    // Rounding may lead to the border itself.
    spot.steps[axis] = std::min(static_cast<std::uint32_t>(spot.place[axis]), last_step);
    entry =
        entry << stored_.table_depth | spot.steps[axis] >> (max_grid_depth - stored_.table_depth);
  }
  const GridTable::Entry& found = stored_.table[entry];
  spot.node = found.node;
  spot.depth = static_cast<int>(found.depth);
  return true;
}

BackgroundGrid::NodeCode BackgroundGrid::child(const Spot& spot) const {
  const int shift = max_grid_depth - 1 - spot.depth;
  if (shift < 0) {
    fail_too_deep();
  }
  const std::uint32_t octant = (spot.steps[0] >> shift & 1) | (spot.steps[1] >> shift & 1) << 1 |
                               (spot.steps[2] >> shift & 1) << 2;
  return stored_.blocks[index_of(spot.node)][octant];
}

double BackgroundGrid::leaf_size(const Spot& spot, const Vec3& p) const {
  if (kind_of(spot.node) == NodeKind::exact) {
    return tree_->fast_size(p, exact_entries(spot.node), stored_.size_limit);
  }
  if (kind_of(spot.node) == NodeKind::tree) {
    return tree_->size(p, stored_.size_limit);
  }
  const std::uint32_t edge = 1u << (max_grid_depth - spot.depth);
  const double scale = 1.0 / edge;
  const auto local = [&](int axis) {
    return scale * (spot.place[axis] - static_cast<double>(spot.steps[axis] & ~(edge - 1)));
  };
  return trilinear(stored_.corners[index_of(spot.node)], local(0), local(1), local(2));
}

double BackgroundGrid::size(const Vec3& p) const {
  bool interpolated = false;
  return size(p, interpolated);
}

double BackgroundGrid::size(const Vec3& p, bool& interpolated) const {
  Spot spot;
  interpolated = false;
  if (!find_in_table(p, spot)) {
    return tree_->size(p, stored_.size_limit);
  }
  while (kind_of(spot.node) == NodeKind::block) {
    spot.node = child(spot);
    ++spot.depth;
  }
  interpolated = kind_of(spot.node) == NodeKind::interpolated;
  return leaf_size(spot, p);
}

void BackgroundGrid::fail_too_deep() {
  throw Error("Cells of a background grid are divided without end: save the field again.");
}

std::size_t BackgroundGrid::sizes(const Vec3* points, std::size_t count, double* sizes) const {
  constexpr std::size_t group = 16;
  std::size_t interpolated = 0;
  std::array<Spot, group> spots;
  std::array<std::size_t, group> open;
  std::array<std::size_t, group> exact_spots;
  std::array<Vec3, group> exact_points;
  std::array<FacetTree::Smallest, group> found;
  for (std::size_t first = 0; first < count; first += group) {
    const std::size_t in_group = std::min(group, count - first);
    std::size_t open_count = 0;
    std::size_t inside = 0;
    for (std::size_t i = 0; i < in_group; ++i) {
      if (find_in_table(points[first + i], spots[i])) {
        open[open_count++] = i;
        inside |= std::size_t{1} << i;
      } else {
        sizes[first + i] = tree_->size(points[first + i], stored_.size_limit);
      }
    }
    // A level at a time: each point's next node is on its way while the others go theirs.
    while (open_count > 0) {
      std::size_t still_open = 0;
      for (std::size_t k = 0; k < open_count; ++k) {
        Spot& spot = spots[open[k]];
        if (kind_of(spot.node) == NodeKind::block) {
          spot.node = child(spot);
          ++spot.depth;
          open[still_open++] = open[k];
          if (kind_of(spot.node) == NodeKind::block) {
            __builtin_prefetch(stored_.blocks.data() + index_of(spot.node));
          } else if (kind_of(spot.node) == NodeKind::interpolated) {
            __builtin_prefetch(stored_.corners.data() + index_of(spot.node));
          }
        }
      }
      open_count = still_open;
    }
    std::size_t exact_count = 0;
    for (std::size_t i = 0; i < in_group; ++i) {
      if ((inside >> i & 1) == 0) {
        continue;
      }
      if (kind_of(spots[i].node) != NodeKind::exact) {
        interpolated += kind_of(spots[i].node) == NodeKind::interpolated ? 1 : 0;
        sizes[first + i] = leaf_size(spots[i], points[first + i]);
        continue;
      }
      exact_spots[exact_count] = i;
      exact_points[exact_count] = points[first + i];
      found[exact_count++] = {stored_.size_limit, FacetTree::Smallest::no_facet};
    }
    tree_->fast_smallest(
        exact_points.data(), exact_count,
        [&](std::size_t k) { return exact_entries(spots[exact_spots[k]].node); }, found.data());
    for (std::size_t k = 0; k < exact_count; ++k) {
      sizes[first + exact_spots[k]] = found[k].size;
    }
  }
  return interpolated;
}

FacetTree::Entries BackgroundGrid::exact_entries(NodeCode leaf) const {
  const std::uint32_t begin = stored_.exact_begin[index_of(leaf)];
  const std::uint32_t end = stored_.exact_begin[index_of(leaf) + 1];
  return {stored_.exact_entries.range(begin, end), static_cast<int>(end - begin)};
}

}  // namespace meshgrow
