#include "facet_tree.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "error.h"

namespace meshgrow {

namespace {

/// Of sizes in float, generously.
constexpr double relative_rounding = 4e-6;

/// Float need not be better than this where it answers alone.
constexpr float good_enough_for_float = 8e-6f;

/// In units of the tree. Squares of what is farther may not be finite in float.
constexpr double farthest_for_float = 1e15;

/// Of start sizes, in units of the tree. Next to a facet so far away that others are smaller than
/// this, float cannot tell those from nothing.
constexpr float smallest_for_float = 1e-30f;

/// In units of the tree, rounded down; infinite without facets.
float smallest_start_size_in(const StoredTree& tree) {
  if (tree.nodes.empty()) {
    return FacetTree::infinity;
  }
  const simd::WideNode& root = tree.nodes[0];
  return *std::min_element(root.start_size, root.start_size + simd::lanes);
}

/// A tree of distances has no start sizes.
bool float_suffices(const StoredTree& tree) {
  return tree.largest_slope >= 1.0 || smallest_start_size_in(tree) >= smallest_for_float;
}

}  // namespace

FacetTree::FacetTree(SizedFacets facets, int threads) {
  // An entry has 24 bits for a node, and there is a node for 56 facets.
  if (facets.size() > std::size_t{simd::max_nodes} * 48) {
    throw Error("A size function has more than 800 million facets: split its sources.");
  }
  if (facets.empty()) {
    return;
  }
  TreeLayout layout = layout_tree(facets, threads);
  stored_.box = layout.box;
  stored_.centre = layout.centre;
  stored_.unit = layout.unit;
  for (const SizedFacet& facet : facets) {
    stored_.largest_slope = std::max(stored_.largest_slope, facet.slope);
  }
  stored_.facets = std::move(facets);
  stored_.order = std::move(layout.order);
  stored_.nodes = std::move(layout.nodes);
  stored_.boxes = std::move(layout.boxes);
  stored_.slopes = std::move(layout.slopes);
  stored_.blocks = std::move(layout.blocks);
  stored_.block_entries = std::move(layout.block_entries);
}

simd::WideTree FacetTree::view() const {
  simd::WideTree view;
  view.nodes = stored_.nodes.data();
  view.slopes = stored_.slopes.data();
  view.blocks = stored_.blocks.data();
  if (stored_.nodes.is_mapped()) {
    view.owner = &stored_;
    view.touch_node = [](const void* owner, std::uint32_t node) {
      const auto& tree = *static_cast<const StoredTree*>(owner);
      static_cast<void>(tree.nodes[node]);
      static_cast<void>(tree.slopes[node]);
    };
    view.touch_block = [](const void* owner, std::uint32_t block) {
      static_cast<void>(static_cast<const StoredTree*>(owner)->blocks[block]);
    };
  }
  return view;
}

Box FacetTree::child_box(std::uint32_t node, int lane) const {
  const WideBoxes& boxes = stored_.boxes[node];
  const Vec3 lower(boxes.lower[0][lane], boxes.lower[1][lane], boxes.lower[2][lane]);
  const Vec3 upper(boxes.upper[0][lane], boxes.upper[1][lane], boxes.upper[2][lane]);
  return Box(stored_.centre + stored_.unit * lower, stored_.centre + stored_.unit * upper);
}

double FacetTree::ray_enters(const Box& box, const Vec3& origin, const Vec3& inverse_direction) {
  double enter = 0.0;
  double leave = infinity;
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(inverse_direction[axis])) {
      if (origin[axis] < box.min()[axis] || origin[axis] > box.max()[axis]) {
        return infinity;
      }
      continue;
    }
    const double a = (box.min()[axis] - origin[axis]) * inverse_direction[axis];
    const double b = (box.max()[axis] - origin[axis]) * inverse_direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  // A little tolerance, or a ray through the rim of a flat box would be lost by rounding.
  return enter <= leave * (1.0 + 1e-12) ? enter : infinity;
}

// ==== Sizes

void FacetTree::Search::begin(const Entries& entries) {
  const Vec3 place = (*p - tree->stored_.centre) / tree->stored_.unit;
  for (int axis = 0; axis < 3; ++axis) {
    query->place[axis] = place[axis];
  }
  query->entries = entries.begin;
  query->entry_count = entries.count;
  query->limit = limit();
  query->count = 0;
  query->context = this;
  query->overflow = [](simd::LeastSize& full) { static_cast<Search*>(full.context)->decide(); };
}

float FacetTree::Search::limit() const {
  const double scaled = best->size / tree->stored_.unit * (1.0 + relative_rounding);
  return scaled < FLT_MAX ? static_cast<float>(scaled) : FLT_MAX;
}

/// The kernel only ruled facets out: among the candidates, double decides.
void FacetTree::Search::decide() {
  for (int i = 0; i < query->count; ++i) {
    if (query->lower_bounds[i] <= query->limit) {
      const std::uint32_t facet = query->facets[i];
      const double size = tree->stored_.facets[facet].size_at(*p);
      if (size < best->size || (size == best->size && facet < best->facet)) {
        *best = {size, facet};
      }
    }
  }
  query->count = 0;
  query->limit = std::min(query->limit, limit());
}

/// The size lies between the least lower bound of a candidate and the limit. If that is not close
/// enough, or some candidates are decided already, double decides.
void FacetTree::Search::decide_if_needed() {
  if (best->facet == Smallest::no_facet && query->count > 0) {
    const float least = *std::min_element(query->lower_bounds, query->lower_bounds + query->count);
    if (least >= query->limit * (1.0f - good_enough_for_float)) {
      best->size = std::min(best->size, query->limit * tree->stored_.unit);
      return;
    }
  }
  decide();
}

void FacetTree::run(simd::LeastSize* queries, std::size_t count) const {
  simd::tree_kernels().least_sizes(view(), queries, static_cast<int>(count));
}

FacetTree::Smallest FacetTree::smallest(const Vec3& p, const Entries& entries,
                                        const Smallest& known) const {
  Smallest best = known;
  search<1>(
      &p, 1, [&entries](std::size_t) { return entries; }, &best, [](Search& one) { one.decide(); });
  return best;
}

double FacetTree::fast_size(const Vec3& p, const Entries& entries, double upper_bound) const {
  Smallest best{upper_bound, Smallest::no_facet};
  search<1>(
      &p, 1, [&entries](std::size_t) { return entries; }, &best,
      [](Search& one) { one.decide_if_needed(); });
  return best.size;
}

double FacetTree::size(const Vec3& p, double upper_bound) const {
  if (!is_near_enough_for_float(p)) {
    return reference_size(p, upper_bound);
  }
  return smallest(p, Entries(), {upper_bound, Smallest::no_facet}).size;
}

void FacetTree::sizes(const Vec3* points, std::size_t count, double upper_bound,
                      double* sizes) const {
  constexpr std::size_t group = 64;
  std::array<Smallest, group> found;
  for (std::size_t first = 0; first < count; first += group) {
    const std::size_t in_group = std::min(group, count - first);
    const Vec3* begin = points + first;
    found.fill({upper_bound, Smallest::no_facet});
    if (std::all_of(begin, begin + in_group,
                    [this](const Vec3& p) { return is_near_enough_for_float(p); })) {
      smallest(
          begin, in_group, [](std::size_t) { return Entries(); }, found.data());
    } else {
      for (std::size_t i = 0; i < in_group; ++i) {
        found[i].size = size(begin[i], upper_bound);
      }
    }
    for (std::size_t i = 0; i < in_group; ++i) {
      sizes[first + i] = found[i].size;
    }
  }
}

double FacetTree::smallest_start_size() const {
  return smallest_start_size_in(stored_) * stored_.unit;
}

bool FacetTree::is_near_enough_for_float(const Vec3& p) const {
  return float_suffices(stored_) &&
         (p - stored_.centre).cwiseAbs().maxCoeff() < farthest_for_float * stored_.unit;
}

double FacetTree::reference_size(const Vec3& p, double upper_bound) const {
  return best_first(
             upper_bound, [](std::size_t, const Box&) { return 0.0; },
             [&](std::uint32_t i) { return stored_.facets[i].size_at(p); })
      .distance;
}

FacetTree::Closest FacetTree::closest_facet(const Vec3& p) const {
  return closest_facet(p, infinity,
                       [&](std::uint32_t i) { return distance(stored_.facets[i].facet, p); });
}

std::size_t FacetTree::memory_bytes() const {
  return stored_.facets.bytes() + stored_.order.bytes() + stored_.nodes.bytes() +
         stored_.boxes.bytes() + stored_.slopes.bytes() + stored_.blocks.bytes() +
         stored_.block_entries.bytes();
}

}  // namespace meshgrow
