#include "background_grid.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "error.h"
#include "grid_builder.h"
#include "grid_cell.h"
#include "number_text.h"

namespace meshgrow {

namespace {

constexpr double smallest_tolerance = 1e-4;

constexpr int max_table_depth = 5;

constexpr std::uint32_t last_step = (1u << max_grid_depth) - 1;

void check(const GridOptions& options) {
  check_tolerance(options.tolerance);
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

BackgroundGrid::BackgroundGrid(std::shared_ptr<const FacetTree> tree, double size_limit,
                               const Box& box, const GridOptions& options)
    : tree_(std::move(tree)), size_limit_(size_limit) {
  check(options);
  const auto start = std::chrono::steady_clock::now();
  if (!box.isEmpty()) {
    // A hair larger, so that points on the box's own faces are inside in spite of rounding.
    const double reach = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
    const double margin = 1e-9 * box.sizes().maxCoeff() + 1e-12 * reach;
    cube_.origin = box.min() - Vec3::Constant(margin);
    cube_.edge = box.sizes().maxCoeff() + 2.0 * margin;
  }
  steps_per_unit_ = cube_.edge > 0.0 ? 1.0 / cube_.step() : 0.0;
  GridBuilder(*this, options).build();
  fill_table();
  statistics_.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  statistics_.interpolated_leaves = nodes_.corners.size();
  statistics_.exact_leaves = nodes_.exact_begin.size() - 1;
  statistics_.blocks = nodes_.blocks.size() - 1;  // one stands above the root
  statistics_.depth = nodes_.depth;
  statistics_.bytes = nodes_.blocks.size() * sizeof(nodes_.blocks[0]) +
                      nodes_.corners.size() * sizeof(CornerValues) +
                      (nodes_.exact_begin.size() + nodes_.exact_entries.size()) * 4 +
                      table_.size() * sizeof(TableEntry);
}

BackgroundGrid::NodeCode BackgroundGrid::code(NodeKind kind, std::size_t index) {
  if (index > 0x3FFFFFFFu) {
    throw Error("The background grid has over a billion cells: raise its tolerance.");
  }
  return static_cast<NodeCode>(kind) << 30 | static_cast<NodeCode>(index);
}

void BackgroundGrid::fill_table() {
  // No more entries than there are blocks, give or take: small grids have small tables.
  while (table_depth_ < max_table_depth &&
         (std::size_t{1} << 3 * table_depth_) < nodes_.blocks.size()) {
    ++table_depth_;
  }
  table_.resize(std::size_t{1} << 3 * table_depth_);
  fill_table(nodes_.blocks[0][0], 0, 0, 0, 0);
}

void BackgroundGrid::fill_table(NodeCode node, int depth, std::uint32_t x, std::uint32_t y,
                                std::uint32_t z) {
  if (kind(node) == NodeKind::block && depth < table_depth_) {
    for (std::uint32_t i = 0; i < 8; ++i) {
      fill_table(nodes_.blocks[index(node)][i], depth + 1, 2 * x + (i & 1), 2 * y + (i >> 1 & 1),
                 2 * z + (i >> 2));
    }
    return;
  }
  const int below = table_depth_ - depth;
  for (std::uint32_t i = 0; i < 1u << 3 * below; ++i) {
    const std::uint32_t mask = (1u << below) - 1;
    const std::uint32_t column = (x << below) + (i & mask);
    const std::uint32_t row = (y << below) + (i >> below & mask);
    const std::uint32_t layer = (z << below) + (i >> 2 * below);
    table_[(layer << 2 * table_depth_) + (row << table_depth_) + column] = {
        node, static_cast<std::uint32_t>(depth)};
  }
}

// ==== Evaluation

bool BackgroundGrid::find_in_table(const Vec3& p, Spot& spot) const {
  const Vec3 local = p - cube_.origin;
  if (!((local.array() >= 0.0).all() && (local.array() < cube_.edge).all())) {
    return false;
  }
  spot.place = local * steps_per_unit_;
  std::size_t entry = 0;
  for (int axis = 2; axis >= 0; --axis) {
    // Rounding may lead to the border itself.
    spot.steps[axis] = std::min(static_cast<std::uint32_t>(spot.place[axis]), last_step);
    entry = entry << table_depth_ | spot.steps[axis] >> (max_grid_depth - table_depth_);
  }
  spot.node = table_[entry].node;
  spot.depth = static_cast<int>(table_[entry].depth);
  return true;
}

BackgroundGrid::NodeCode BackgroundGrid::child(const Spot& spot) const {
  const int shift = max_grid_depth - 1 - spot.depth;
  const std::uint32_t octant = (spot.steps[0] >> shift & 1) | (spot.steps[1] >> shift & 1) << 1 |
                               (spot.steps[2] >> shift & 1) << 2;
  return nodes_.blocks[index(spot.node)][octant];
}

double BackgroundGrid::leaf_size(const Spot& spot, const Vec3& p) const {
  if (kind(spot.node) == NodeKind::exact) {
    return tree_->fast_size(p, exact_entries(spot.node), size_limit_);
  }
  if (kind(spot.node) == NodeKind::tree) {
    return tree_->size(p, size_limit_);
  }
  const std::uint32_t edge = 1u << (max_grid_depth - spot.depth);
  const double scale = 1.0 / edge;
  const auto local = [&](int axis) {
    return scale * (spot.place[axis] - static_cast<double>(spot.steps[axis] & ~(edge - 1)));
  };
  return trilinear(nodes_.corners[index(spot.node)], local(0), local(1), local(2));
}

double BackgroundGrid::size(const Vec3& p) const {
  bool interpolated = false;
  return size(p, interpolated);
}

double BackgroundGrid::size(const Vec3& p, bool& interpolated) const {
  Spot spot;
  interpolated = false;
  if (!find_in_table(p, spot)) {
    return tree_->size(p, size_limit_);
  }
  while (kind(spot.node) == NodeKind::block) {
    spot.node = child(spot);
    ++spot.depth;
  }
  interpolated = kind(spot.node) == NodeKind::interpolated;
  return leaf_size(spot, p);
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
        sizes[first + i] = tree_->size(points[first + i], size_limit_);
      }
    }
    // A level at a time: each point's next node is on its way while the others go theirs.
    while (open_count > 0) {
      std::size_t still_open = 0;
      for (std::size_t k = 0; k < open_count; ++k) {
        Spot& spot = spots[open[k]];
        if (kind(spot.node) == NodeKind::block) {
          spot.node = child(spot);
          ++spot.depth;
          open[still_open++] = open[k];
          if (kind(spot.node) == NodeKind::block) {
            __builtin_prefetch(&nodes_.blocks[index(spot.node)]);
          } else if (kind(spot.node) == NodeKind::interpolated) {
            __builtin_prefetch(&nodes_.corners[index(spot.node)]);
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
      if (kind(spots[i].node) != NodeKind::exact) {
        interpolated += kind(spots[i].node) == NodeKind::interpolated ? 1 : 0;
        sizes[first + i] = leaf_size(spots[i], points[first + i]);
        continue;
      }
      exact_spots[exact_count] = i;
      exact_points[exact_count] = points[first + i];
      found[exact_count++] = {size_limit_, FacetTree::Smallest::no_facet};
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
  const std::uint32_t begin = nodes_.exact_begin[index(leaf)];
  const std::uint32_t end = nodes_.exact_begin[index(leaf) + 1];
  return {nodes_.exact_entries.data() + begin, static_cast<int>(end - begin)};
}

}  // namespace meshgrow
