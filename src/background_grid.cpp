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
    : tree_(std::move(tree)), size_limit_(size_limit), origin_(Vec3::Zero()), edge_(0.0) {
  check(options);
  const auto start = std::chrono::steady_clock::now();
  if (!box.isEmpty()) {
    // A hair larger, so that points on the box's own faces are inside in spite of rounding.
    const double reach = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
    const double margin = 1e-9 * box.sizes().maxCoeff() + 1e-12 * reach;
    origin_ = box.min() - Vec3::Constant(margin);
    edge_ = box.sizes().maxCoeff() + 2.0 * margin;
  }
  GridBuilder(*this, options).build();
  statistics_.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  root_ = nodes_.blocks[0][0];
  statistics_.interpolated_leaves = nodes_.corners.size();
  statistics_.exact_leaves = nodes_.exact_begin.size() - 1;
  statistics_.blocks = nodes_.blocks.size() - 1;  // one stands above the root
  statistics_.depth = nodes_.depth;
  statistics_.bytes = nodes_.blocks.size() * sizeof(nodes_.blocks[0]) +
                      nodes_.corners.size() * sizeof(CornerValues) +
                      (nodes_.exact_begin.size() + nodes_.exact_facets.size()) * 4;
}

BackgroundGrid::NodeCode BackgroundGrid::code(NodeKind kind, std::size_t index) {
  if (index > 0x3FFFFFFFu) {
    throw Error("The background grid has over a billion cells: raise its tolerance.");
  }
  return static_cast<NodeCode>(kind) << 30 | static_cast<NodeCode>(index);
}

double BackgroundGrid::size(const Vec3& p) const {
  Vec3 local = p - origin_;
  if (!((local.array() >= 0.0).all() && (local.array() < edge_).all())) {
    return tree_->size(p, size_limit_);
  }
  local /= edge_;
  NodeCode node = root_;
  while (kind(node) == NodeKind::block) {
    local *= 2.0;
    int child = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (local[axis] >= 1.0) {
        local[axis] -= 1.0;
        child |= 1 << axis;
      }
    }
    node = nodes_.blocks[index(node)][child];
  }
  switch (kind(node)) {
    case NodeKind::interpolated:
      return trilinear(nodes_.corners[index(node)], local.x(), local.y(), local.z());
    case NodeKind::exact:
      return exact_leaf_size(index(node), p);
    default:
      return tree_->size(p, size_limit_);
  }
}

double BackgroundGrid::exact_leaf_size(std::uint32_t leaf, const Vec3& p) const {
  double size = size_limit_;
  for (std::uint32_t i = nodes_.exact_begin[leaf]; i < nodes_.exact_begin[leaf + 1]; ++i) {
    size = std::min(size, tree_->facets()[nodes_.exact_facets[i]].size_at(p));
  }
  return size;
}

}  // namespace meshgrow
