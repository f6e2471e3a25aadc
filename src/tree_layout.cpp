#include "tree_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "facet_block.h"
#include "oriented_box.h"
#include "parallel.h"
#include "tree_shape.h"

namespace meshgrow {

namespace {

using simd::FacetBlock;
using simd::WideNode;

constexpr std::uint32_t lanes = simd::lanes;
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Boxes are enlarged by this much, in units of the tree: more than a place within it is moved by
/// rounding to float.
constexpr double box_margin = 2.5e-7;

/// Subtrees of at most so many blocks are one piece of parallel work.
constexpr std::uint32_t blocks_per_task = 512;

std::uint32_t blocks_for(std::uint32_t facets) { return (facets + lanes - 1) / lanes; }

float rounded_down(double x) {
  const float rounded = static_cast<float>(x);
  return rounded <= x ? rounded : std::nextafter(rounded, -infinity);
}

float rounded_up(double x) { return -rounded_down(-x); }

/// What a node knows of one child.
struct Summary {
  Box box;
  OrientedBox oriented;
  Spread spread;
  float start_size = infinity;
  float slope = infinity;

  void add(const Summary& other) {
    box.extend(other.box);
    spread.add(other.spread);
    start_size = std::min(start_size, other.start_size);
    slope = std::min(slope, other.slope);
  }
};

/// Splits by medians, always into full subtrees, so that nodes and blocks have places known
/// beforehand and subtrees can be built side by side.
class TreeBuilder {
 public:
  TreeBuilder(SizedFacets& facets, int threads, TreeLayout& layout)
      : facets_(facets), threads_(threads), layout_(layout) {}

  void build() {
    const auto count = static_cast<std::uint32_t>(facets_.size());
    find_frame();
    const std::uint32_t blocks = blocks_for(count);
    layout_.nodes.resize(nodes_for(blocks));
    layout_.boxes.resize(layout_.nodes.size());
    layout_.slopes.resize(layout_.nodes.size());
    node_summaries_.resize(layout_.nodes.size());
    layout_.blocks.resize(blocks);
    layout_.block_entries.resize(blocks);
    split_top({0, count, 0});
    parallel_for(tasks_.size(), threads_, [&](std::size_t i) { split_subtree(tasks_[i]); });
    bring_into_order();
    parallel_for(tasks_.size(), threads_, [&](std::size_t i) { finish_subtree(tasks_[i]); });
    for (const Range& block : lone_blocks_) {
      finish_block(block);
    }
    for (std::size_t i = top_.size(); i-- > 0;) {
      finish_node(top_[i]);
    }
  }

 private:
  struct Item {
    float centroid[3];
    std::uint32_t facet;
  };

  struct Range {
    std::uint32_t first;
    std::uint32_t count;
    std::uint32_t node;
    std::uint32_t blocks() const { return blocks_for(count); }
  };

  void find_frame();
  void split_top(const Range& range);
  void split_children(const Range& range);
  void split_subtree(const Range& range);
  void bring_into_order();
  void finish_subtree(const Range& range);
  void finish_block(const Range& range);
  void finish_node(const Range& range);
  template <typename Visit>
  void for_each_child(const Range& range, Visit visit) const;
  void split(std::uint32_t first, std::uint32_t count, std::uint32_t children,
             std::uint32_t facets_per_child);
  Summary fill_block(std::uint32_t index, std::uint32_t first, std::uint32_t count);
  Vec3 scaled(const Vec3& p) const { return (p - layout_.centre) * scale_; }

  SizedFacets& facets_;
  int threads_;
  double scale_ = 1.0;
  TreeLayout& layout_;
  std::vector<Item> items_;
  std::vector<Range> tasks_;
  std::vector<Range> top_;
  std::vector<Range> lone_blocks_;  ///< children of top nodes
  /// Of blocks, for the nodes above them.
  std::vector<Summary> block_summaries_;
  std::vector<Summary> node_summaries_;
};

void TreeBuilder::find_frame() {
  const std::size_t count = facets_.size();
  const std::size_t chunk = 1 << 16;
  const std::size_t chunks = (count + chunk - 1) / chunk;
  std::vector<Box> boxes(chunks);
  std::vector<double> smallest(chunks, infinity);
  parallel_for(chunks, threads_, [&](std::size_t c) {
    for (std::size_t i = c * chunk; i < std::min(count, (c + 1) * chunk); ++i) {
      const SizedFacet& facet = facets_[i];
      for (int k = 0; k < facet.facet.corner_count; ++k) {
        boxes[c].extend(facet.facet.corners[k]);
      }
      smallest[c] = std::min(smallest[c], facet.start_size);
    }
  });
  double smallest_size = infinity;
  for (std::size_t c = 0; c < chunks; ++c) {
    layout_.box.extend(boxes[c]);
    smallest_size = std::min(smallest_size, smallest[c]);
  }
  layout_.centre = layout_.box.center();
  layout_.unit = std::max(layout_.box.sizes().maxCoeff(), 1e-6 * smallest_size);
  if (!(layout_.unit > 0.0)) {
    layout_.unit = 1.0;  // one point of no size
  }
  scale_ = 1.0 / layout_.unit;
  items_.resize(count);
  block_summaries_.resize(blocks_for(static_cast<std::uint32_t>(count)));
  parallel_for(chunks, threads_, [&](std::size_t c) {
    for (std::size_t i = c * chunk; i < std::min(count, (c + 1) * chunk); ++i) {
      const Vec3 centroid = scaled(facets_[i].facet.centroid());
      items_[i] = {{static_cast<float>(centroid.x()), static_cast<float>(centroid.y()),
                    static_cast<float>(centroid.z())},
                   static_cast<std::uint32_t>(i)};
    }
  });
}

/// Visits (child number, its range); the range's node counts only where it has more than a block.
template <typename Visit>
void TreeBuilder::for_each_child(const Range& range, Visit visit) const {
  const std::uint32_t capacity = blocks_per_child(range.blocks());
  std::uint32_t node = range.node + 1;
  std::uint32_t child = 0;
  for (std::uint32_t done = 0; done < range.count; done += capacity * lanes) {
    const Range part{range.first + done, std::min(capacity * lanes, range.count - done), node};
    visit(child++, part);
    if (part.blocks() > 1) {
      node += nodes_for(part.blocks());
    }
  }
}

void TreeBuilder::split(std::uint32_t first, std::uint32_t count, std::uint32_t children,
                        std::uint32_t facets_per_child) {
  if (children <= 1) {
    return;
  }
  float low[3] = {infinity, infinity, infinity};
  float high[3] = {-infinity, -infinity, -infinity};
  Item* begin = items_.data() + first;
  for (const Item* item = begin; item != begin + count; ++item) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], item->centroid[axis]);
      high[axis] = std::max(high[axis], item->centroid[axis]);
    }
  }
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis) {
    longest = high[axis] - low[axis] > high[longest] - low[longest] ? axis : longest;
  }
  const std::uint32_t half = children / 2;
  const std::uint32_t middle = half * facets_per_child;
  std::nth_element(begin, begin + middle, begin + count, [longest](const Item& a, const Item& b) {
    return a.centroid[longest] < b.centroid[longest];
  });
  split(first, middle, half, facets_per_child);
  split(first + middle, count - middle, children - half, facets_per_child);
}

void TreeBuilder::split_children(const Range& range) {
  const std::uint32_t capacity = blocks_per_child(range.blocks());
  split(range.first, range.count, (range.blocks() + capacity - 1) / capacity, capacity * lanes);
}

void TreeBuilder::split_top(const Range& range) {
  if (range.blocks() <= blocks_per_task) {
    tasks_.push_back(range);
    return;
  }
  top_.push_back(range);
  split_children(range);
  for_each_child(range, [&](std::uint32_t, const Range& child) {
    if (child.blocks() > 1) {
      split_top(child);
    } else {
      lone_blocks_.push_back(child);
    }
  });
}

void TreeBuilder::split_subtree(const Range& range) {
  split_children(range);
  for_each_child(range, [&](std::uint32_t, const Range& child) {
    if (child.blocks() > 1) {
      split_subtree(child);
    }
  });
}

void TreeBuilder::bring_into_order() {
  SizedFacets ordered(facets_.size());
  layout_.order.resize(facets_.size());
  constexpr std::size_t chunk = 1 << 13;
  parallel_for((facets_.size() + chunk - 1) / chunk, threads_, [&](std::size_t c) {
    constexpr std::size_t ahead = 12;  // memory is slow to answer
    const std::size_t end = std::min(facets_.size(), (c + 1) * chunk);
    for (std::size_t i = c * chunk; i < end; ++i) {
      const char* later =
          reinterpret_cast<const char*>(&facets_[items_[std::min(i + ahead, end - 1)].facet]);
      __builtin_prefetch(later);
      __builtin_prefetch(later + 64);
      layout_.order[i] = items_[i].facet;
      ordered[i] = facets_[items_[i].facet];
    }
  });
  facets_ = std::move(ordered);
  std::vector<Item>().swap(items_);
}

void TreeBuilder::finish_subtree(const Range& range) {
  for_each_child(range, [&](std::uint32_t, const Range& child) {
    if (child.blocks() > 1) {
      finish_subtree(child);
    } else {
      finish_block(child);
    }
  });
  finish_node(range);
}

void TreeBuilder::finish_block(const Range& range) {
  const std::uint32_t block = range.first / lanes;
  block_summaries_[block] = fill_block(block, range.first, range.count);
}

void TreeBuilder::finish_node(const Range& range) {
  WideNode& node = layout_.nodes[range.node];
  WideBoxes& boxes = layout_.boxes[range.node];
  node = WideNode();
  std::fill(node.start_size, node.start_size + lanes, infinity);
  Summary all;
  std::array<OrientedBox, lanes> below;
  std::uint32_t children = 0;
  for_each_child(range, [&](std::uint32_t lane, const Range& child) {
    const bool is_block = child.blocks() == 1;
    const Summary& summary =
        is_block ? block_summaries_[child.first / lanes] : node_summaries_[child.node];
    const OrientedBox& oriented = below[children++] = summary.oriented;
    for (int axis = 0; axis < 3; ++axis) {
      boxes.lower[axis][lane] = rounded_down(summary.box.min()[axis] - box_margin);
      boxes.upper[axis][lane] = rounded_up(summary.box.max()[axis] + box_margin);
      node.centre[axis][lane] = static_cast<float>(oriented.centre[axis]);
      node.first_axis[axis][lane] = static_cast<float>(oriented.axes(axis, 0));
      node.second_axis[axis][lane] = static_cast<float>(oriented.axes(axis, 1));
      // Rounding moves the place and the centre, and turns the axes.
      const double margin = box_margin + 1e-6 * oriented.half_sizes.maxCoeff();
      node.half_sizes[axis][lane] = rounded_up(oriented.half_sizes[axis] + margin);
    }
    node.start_size[lane] = summary.start_size;
    node.child[lane] = is_block ? child.first / lanes | WideNode::is_block : child.node;
    if (is_block) {
      layout_.block_entries[child.first / lanes] = range.node << 8 | 1u << lane;
    }
    all.add(summary);
  });
  all.oriented = oriented_box(below.data(), children, all.spread, all.box);
  layout_.slopes[range.node] = all.slope;
  node_summaries_[range.node] = all;
}

Summary TreeBuilder::fill_block(std::uint32_t index, std::uint32_t first, std::uint32_t count) {
  FacetBlock& block = layout_.blocks[index];
  block = FacetBlock();
  std::fill(block.start_size, block.start_size + lanes, infinity);
  block.first = first;
  block.count = count;
  const Vec3 origin = facets_[first].facet.corners[0];
  const Vec3 scaled_origin = scaled(origin);
  std::copy(scaled_origin.data(), scaled_origin.data() + 3, block.origin);
  Summary summary;
  double reach = 0.0;
  double start_size = infinity;
  double slope = infinity;
  Vec3 normal = Vec3::Zero();
  double areas = 0.0;
  std::array<Vec3, 3 * lanes> corners;
  std::size_t corner_count = 0;
  for (std::uint32_t lane = 0; lane < count; ++lane) {
    const SizedFacet& facet = facets_[first + lane];
    const Vec3 area = set_facet(block, lane, facet, origin, layout_.unit);
    normal += area.dot(normal) < 0.0 ? Vec3(-area) : area;
    areas += area.norm();
    start_size = std::min(start_size, facet.start_size);
    slope = std::min(slope, facet.slope);
    for (int k = 0; k < facet.facet.corner_count; ++k) {
      const Vec3 corner = scaled(facet.facet.corners[k]);
      reach = std::max(reach, (corner - scaled_origin).squaredNorm());
      summary.box.extend(corner);
      summary.spread.add(corner);
      corners[corner_count++] = corner;
    }
  }
  summary.start_size = rounded_down(std::min(start_size / layout_.unit, largest_start_size));
  summary.slope = rounded_down(slope);
  // Boxes lie across the normal of a piece of a surface, whose facets may be turned either way, and
  // along a piece of a curve. Corners have neither.
  summary.oriented = areas > 1e-100 && normal.squaredNorm() > 0.9 * areas * areas
                         ? oriented_box(corners.data(), corner_count, normal, summary.box)
                         : oriented_box(corners.data(), corner_count, summary.spread, summary.box);
  // Rounding to float moves corners and turns frames by 6e-8 of the reach at most, a few times;
  // places relative to the centre are rounded to double.
  block.place_error = static_cast<float>(1e-6 * std::sqrt(reach) + 4e-16);
  return summary;
}

}  // namespace

TreeLayout layout_tree(SizedFacets& facets, int threads) {
  TreeLayout layout;
  TreeBuilder(facets, threads, layout).build();
  return layout;
}

}  // namespace meshgrow
