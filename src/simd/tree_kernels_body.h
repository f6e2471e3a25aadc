// The kernels, compiled once for each instruction set. The including file defines KERNEL_NAMESPACE
// and KERNEL_NAME. Uses no templates or inline functions of libraries: the linker might take a copy
// made for newer processors than the one at hand.

#include <cstdint>

#ifdef __AVX__
#include <immintrin.h>
#endif

#include "tree_kernels.h"

namespace meshgrow::simd {
namespace KERNEL_NAMESPACE {
namespace {

#include "float8.h"

constexpr float relative_rounding = 2e-6f;  ///< of sizes in float, generously

struct Place {
  Float8 x, y, z;
};

inline Float8 dot(const Place& a, const Place& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

inline Place cross(const Place& a, const Place& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// a x + b y + c z.
inline Place combined(const Place& a, Float8 x, const Place& b, Float8 y, const Place& c,
                      Float8 z) {
  return {a.x * x + b.x * y + c.x * z, a.y * x + b.y * y + c.y * z, a.z * x + b.z * y + c.z * z};
}

inline Place float_place(const double* p) {
  return {all(static_cast<float>(p[0])), all(static_cast<float>(p[1])),
          all(static_cast<float>(p[2]))};
}

// ==== Boxes and facets

/// How far outside a box a place is along one of its axes: below 0 on the negative side.
inline Float8 excess(Float8 along, Float8 half_size) {
  return along - min(max(along, -half_size), half_size);
}

/// A place as the boxes around the children of a node see it.
struct BoxView {
  Place first, second, third;  ///< axes
  Place away;                  ///< from the centres to the place
  Float8 x, y, z;  ///< from the nearest points of the boxes to the place, along the axes

  BoxView(const WideNode& node, const Place& p)
      : first{load(node.first_axis[0]), load(node.first_axis[1]), load(node.first_axis[2])},
        second{load(node.second_axis[0]), load(node.second_axis[1]), load(node.second_axis[2])},
        third(cross(first, second)) {
    away = {p.x - load(node.centre[0]), p.y - load(node.centre[1]), p.z - load(node.centre[2])};
    x = excess(dot(away, first), load(node.half_sizes[0]));
    y = excess(dot(away, second), load(node.half_sizes[1]));
    z = excess(dot(away, third), load(node.half_sizes[2]));
  }

  Float8 distance() const { return sqrt(x * x + y * y + z * z); }
};

inline Float8 lower_bounds(const WideNode& node, float slope, const Place& p) {
  return load(node.start_size) + all(slope) * BoxView(node, p).distance();
}

/// A number of each facet in its lane.
struct EachInItsLane {
  Float8 operator()(const float (&numbers)[lanes]) const { return load(numbers); }
};

/// The number of one facet in all lanes.
struct OneInAllLanes {
  int lane;
  Float8 operator()(const float (&numbers)[lanes]) const { return all(numbers[lane]); }
};

/// Places as facets see them, given relative to the origin of the facets' block.
struct FacetView {
  Place along, across, normal;
  Float8 dx, dy, dz;  ///< from the closest points to the place, in the facets' frames
  Float8 distance;

  template <typename Take>
  FacetView(const FacetBlock& block, Take take, const Place& p) {
    const auto take_place = [&take](const float(&from)[3][lanes]) {
      return Place{take(from[0]), take(from[1]), take(from[2])};
    };
    along = take_place(block.along);
    across = take_place(block.across);
    normal = cross(along, across);
    const Place corner = take_place(block.corner);
    const Place away = {p.x - corner.x, p.y - corner.y, p.z - corner.z};
    const Float8 x = dot(away, along);
    const Float8 y = dot(away, across);
    dz = dot(away, normal);

    const Float8 zero = all(0.0f), one = all(1.0f), tiny = all(1e-36f);
    const Float8 side = take(block.length), foot = take(block.foot), height = take(block.height);
    // Along the longest side.
    dx = x - min(max(x, zero), side);
    dy = y;
    Float8 best = dx * dx + dy * dy;
    // Along the side from the first corner to the third.
    const Float8 t =
        min(max((x * foot + y * height) / (foot * foot + height * height + tiny), zero), one);
    const Float8 ex = x - t * foot, ey = y - t * height;
    const Float8 e = ex * ex + ey * ey;
    dx = e < best ? ex : dx;
    dy = e < best ? ey : dy;
    best = min(best, e);
    // Along the side from the second corner to the third.
    const Float8 back = foot - side;
    const Float8 xb = x - side;
    const Float8 s =
        min(max((xb * back + y * height) / (back * back + height * height + tiny), zero), one);
    const Float8 fx = xb - s * back, fy = y - s * height;
    const Float8 f = fx * fx + fy * fy;
    dx = f < best ? fx : dx;
    dy = f < best ? fy : dy;
    best = min(best, f);
    // Above the inside.
    const Int8 inside =
        (y > zero) & (foot * y <= height * x) & (back * y >= height * xb) & (height > zero);
    dx = inside ? zero : dx;
    dy = inside ? zero : dy;
    best = inside ? zero : best;
    distance = sqrt(best + dz * dz);
  }

  /// From the closest points to the place.
  Place way() const { return combined(along, dx, across, dy, normal, dz); }
};

inline FacetView view_of(const FacetBlock& block, const double* p) {
  return FacetView(block, EachInItsLane(),
                   {all(static_cast<float>(p[0] - block.origin[0])),
                    all(static_cast<float>(p[1] - block.origin[1])),
                    all(static_cast<float>(p[2] - block.origin[2]))});
}

// ==== Descent

/// Number of the least of the values at the bits of the mask, which has one at least.
inline int least_lane(Float8 values, unsigned mask) {
  if ((mask & (mask - 1)) == 0) {
    return __builtin_ctz(mask);
  }
#ifdef __AVX__
  const Int8 bit = {1, 2, 4, 8, 16, 32, 64, 128};
  const Int8 wanted = (bit & static_cast<std::int32_t>(mask)) != 0;
  values = wanted ? values : all(3.4e38f);
  Float8 least = _mm256_min_ps(values, _mm256_permute2f128_ps(values, values, 1));
  least = _mm256_min_ps(least, _mm256_permute_ps(least, 0x4E));
  least = _mm256_min_ps(least, _mm256_permute_ps(least, 0xB1));
  const unsigned found = bits(values <= least) & mask;
  return __builtin_ctz(found != 0 ? found : mask);  // none is, if all are beyond float's numbers
#else
  int least = __builtin_ctz(mask);
  for (mask &= mask - 1; mask != 0; mask &= mask - 1) {
    const int lane = __builtin_ctz(mask);
    least = values[lane] < values[least] ? lane : least;
  }
  return least;
#endif
}

/// A node on the way down: children still to be visited, and their bounds.
struct Level {
  Float8 bounds;
  const WideNode* node;
  unsigned mask;
};

constexpr int max_levels = 12;

/// Entries looked at together, so that the most promising comes first.
constexpr int entries_at_once = 32;

/// A search on its way. `Search` has enter(child), the level of a node; ask(block), which looks at
/// a block and is false once the search is over; and limit(), which bounds have to be below, or
/// equal to.
template <typename Search>
struct Descent {
  Search search;
  static constexpr std::uint32_t none = 0xFFFFFFFFu;
  std::uint32_t chosen = none;
  int top = -1;  ///< level; -1: take the next start
  const NodeEntry* entries = nullptr;
  int entries_left = 0;
  int next = 0;
  int starts_count = 0;
  Level levels[max_levels];
  Level starts[entries_at_once];

  void begin(const NodeEntry* from, int count) {
    chosen = none;
    top = -1;
    entries = from;
    entries_left = count;
    refill();
  }

  /// Takes the next entries. The first start is then the one with the least bound of a child.
  void refill() {
    const int count = entries_left < entries_at_once ? entries_left : entries_at_once;
    next = 0;
    starts_count = 0;
    int best = 0;
    float least = 3.4e38f;
    for (int i = 0; i < count; ++i) {
      Level& start = starts[starts_count];
      start = search.enter(entries[i] >> 8);
      start.mask = entries[i] & bits(start.bounds <= all(search.limit()));
      if (start.mask == 0) {
        continue;
      }
      if (count > 1) {
        const float bound = start.bounds[least_lane(start.bounds, start.mask)];
        if (bound < least) {
          least = bound;
          best = starts_count;
        }
      }
      ++starts_count;
    }
    if (best != 0) {
      const Level first = starts[0];
      starts[0] = starts[best];
      starts[best] = first;
    }
    entries += count;
    entries_left -= count;
  }

  /// Visits the child chosen before and chooses the most promising one that is left, whose memory
  /// is asked for until the next step. False at the end.
  bool step() {
    if (chosen != none) {
      const std::uint32_t child = chosen;
      chosen = none;
      if ((child & WideNode::is_block) != 0) {
        if (!search.ask(child & ~WideNode::is_block)) {
          return false;
        }
      } else {
        levels[++top] = search.enter(child);
      }
    }
    for (;;) {
      if (top < 0) {
        while (next == starts_count) {
          if (entries_left == 0) {
            return false;
          }
          refill();
        }
        levels[top = 0] = starts[next++];
      }
      Level& level = levels[top];
      const unsigned mask = level.mask & bits(level.bounds <= all(search.limit()));
      if (mask == 0) {
        --top;
        continue;
      }
      const int lane = least_lane(level.bounds, mask);
      level.mask = mask & ~(1u << lane);
      chosen = level.node->child[lane];
      search.prefetch(chosen);
      return true;
    }
  }
};

inline const WideNode& node_of(const WideTree& tree, std::uint32_t index) {
  if (tree.touch_node != nullptr) {
    tree.touch_node(tree.owner, index);
  }
  return tree.nodes[index];
}

inline const FacetBlock& block_of(const WideTree& tree, std::uint32_t index) {
  if (tree.touch_block != nullptr) {
    tree.touch_block(tree.owner, index);
  }
  return tree.blocks[index];
}

inline void prefetch_lines(const void* begin, int bytes) {
  for (int i = 0; i < bytes; i += 64) {
    __builtin_prefetch(static_cast<const char*>(begin) + i);
  }
}

inline void prefetch_child(const WideTree& tree, std::uint32_t child) {
  if ((child & WideNode::is_block) != 0) {
    prefetch_lines(tree.blocks + (child & ~WideNode::is_block), sizeof(FacetBlock));
  } else {
    prefetch_lines(tree.nodes + child, sizeof(WideNode));
  }
}

// ==== Least size

inline void add_candidate(LeastSize& query, std::uint32_t facet, float lower_bound) {
  if (query.count == LeastSize::capacity) {
    int kept = 0;
    for (int i = 0; i < query.count; ++i) {
      if (query.lower_bounds[i] <= query.limit) {
        query.facets[kept] = query.facets[i];
        query.lower_bounds[kept++] = query.lower_bounds[i];
      }
    }
    query.count = kept;
    if (query.count > LeastSize::capacity / 2) {
      query.overflow(query);
    }
  }
  query.facets[query.count] = facet;
  query.lower_bounds[query.count++] = lower_bound;
}

inline void ask_block(const FacetBlock& block, LeastSize& query) {
  const FacetView view = view_of(block, query.place);
  const Float8 slope = load(block.slope);
  const Float8 size = load(block.start_size) + slope * view.distance;
  const Float8 error = slope * all(block.place_error);
  const Float8 lowest = size - error;
  unsigned mask = bits(lowest <= all(query.limit));
  if (mask == 0) {
    return;
  }
  alignas(32) float low[lanes];
  alignas(32) float high[lanes];
  *reinterpret_cast<Float8*>(low) = lowest;
  *reinterpret_cast<Float8*>(high) = (size + error) * all(1.0f + relative_rounding);
  for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
    const int lane = __builtin_ctz(rest);
    query.limit = high[lane] < query.limit ? high[lane] : query.limit;
  }
  for (; mask != 0; mask &= mask - 1) {
    const int lane = __builtin_ctz(mask);
    if (low[lane] <= query.limit) {
      add_candidate(query, block.first + static_cast<std::uint32_t>(lane), low[lane]);
    }
  }
}

struct LeastSizeSearch {
  const WideTree* tree;
  LeastSize* query;
  Place place;

  Level enter(std::uint32_t index) const {
    const WideNode& node = node_of(*tree, index);
    return {lower_bounds(node, tree->slopes[index], place), &node, all_children};
  }
  bool ask(std::uint32_t block) const {
    ask_block(block_of(*tree, block), *query);
    return true;
  }
  float limit() const { return query->limit; }
  void prefetch(std::uint32_t child) const { prefetch_child(*tree, child); }
};

/// Searches that go on by turns: while one waits for its numbers, the others have theirs.
constexpr int searches_at_once = 8;

void least_sizes(const WideTree& tree, LeastSize* queries, int count) {
  Descent<LeastSizeSearch> descents[searches_at_once];
  Descent<LeastSizeSearch>* open[searches_at_once];
  for (int first = 0; first < count; first += searches_at_once) {
    int left = count - first < searches_at_once ? count - first : searches_at_once;
    for (int i = 0; i < left; ++i) {
      LeastSize& query = queries[first + i];
      open[i] = &descents[i];
      descents[i].search = {&tree, &query, float_place(query.place)};
      descents[i].begin(query.entries, query.entry_count);
    }
    while (left > 0) {
      for (int i = 0; i < left; ++i) {
        if (!open[i]->step()) {
          open[i--] = open[--left];
        }
      }
    }
  }
}

// ==== Tangent planes at the corners of a cell

/// Least of plane(corner) · reciprocal(corner), with the planes given at the centre.
inline Float8 least_ratios(const CellCorners& cell, Float8 at_centre, const Place& slopes) {
  const Float8 h = all(cell.half_edge);
  const Float8 x = slopes.x * h, y = slopes.y * h, z = slopes.z * h;
  const Float8 below = at_centre - z, above = at_centre + z;
  const Float8 sum = x + y, difference = x - y;
  const float* r = cell.reciprocals;
  Float8 least = (below - sum) * all(r[0]);
  least = min(least, (below + difference) * all(r[1]));
  least = min(least, (below - difference) * all(r[2]));
  least = min(least, (below + sum) * all(r[3]));
  least = min(least, (above - sum) * all(r[4]));
  least = min(least, (above + difference) * all(r[5]));
  least = min(least, (above - difference) * all(r[6]));
  return min(least, (above + sum) * all(r[7]));
}

/// A box is convex as a facet is: its distance has a tangent plane, too.
struct BoxRatios {
  Float8 bounds;  ///< of sizes at the centre
  Float8 ratios;

  BoxRatios(const WideNode& node, float slope, const CellCorners& cell, const Place& centre) {
    const BoxView view(node, centre);
    const Float8 distance = view.distance();
    bounds = load(node.start_size) + all(slope) * distance;
    const Float8 steepness = all(slope) / max(distance, all(1e-30f));
    const Place slopes = combined(view.first, steepness * view.x, view.second, steepness * view.y,
                                  view.third, steepness * view.z);
    // Close to the box, rounding turns the direction: that is taken off the plane.
    const Float8 reach =
        max(max(absolute(view.away.x), absolute(view.away.y)), absolute(view.away.z));
    const Float8 turned = steepness * reach * all(2e-6f * cell.half_edge);
    // An infinite start size gives infinite ratios, as no corner's reciprocal is 0.
    ratios = least_ratios(cell, bounds - turned, slopes);
  }
};

inline Float8 block_ratios(const FacetBlock& block, const CellCorners& cell) {
  const FacetView view = view_of(block, cell.centre);
  const Float8 slope = load(block.slope);
  const Place way = view.way();
  // Rounding moves the place and turns the direction: both are taken off the plane.
  const Float8 error = all(block.place_error) + view.distance * all(5e-7f);
  const Float8 distance = max(view.distance, all(1e-30f));
  const Float8 turned = all(1.8f * cell.half_edge) * error / distance;
  const Int8 has_direction = view.distance > all(8.0f) * error;
  const Float8 steepness = has_direction ? slope / distance : all(0.0f);
  const Float8 at_centre = load(block.start_size) +
                           (has_direction ? slope * (view.distance - error - turned) : all(0.0f));
  return least_ratios(cell, at_centre, {way.x * steepness, way.y * steepness, way.z * steepness});
}

struct LeastRatioSearch {
  const WideTree* tree;
  LeastRatio* query;
  Place centre;

  Level enter(std::uint32_t index) const {
    const WideNode& node = node_of(*tree, index);
    return {BoxRatios(node, tree->slopes[index], query->cell, centre).ratios, &node, all_children};
  }
  bool ask(std::uint32_t block) const {
    const Float8 ratios = block_ratios(block_of(*tree, block), query->cell);
    const float least = ratios[least_lane(ratios, all_children)];
    query->ratio = least < query->ratio ? least : query->ratio;
    return query->ratio >= query->enough;
  }
  float limit() const { return query->ratio; }
  void prefetch(std::uint32_t /*block*/) const {}
};

void least_ratio(const WideTree& tree, const NodeEntry* entries, int count, LeastRatio& query) {
  Descent<LeastRatioSearch> descent;
  descent.search = {&tree, &query, float_place(query.cell.centre)};
  descent.begin(entries, count);
  while (descent.step()) {
  }
}

// ==== Sizes at the corners of a cell

void corner_sizes(const FacetBlock& block, int lane, const CellCorners& cell, float* sizes) {
  const Float8 x_sign = {-1, 1, -1, 1, -1, 1, -1, 1};
  const Float8 y_sign = {-1, -1, 1, 1, -1, -1, 1, 1};
  const Float8 z_sign = {-1, -1, -1, -1, 1, 1, 1, 1};
  const Float8 h = all(cell.half_edge);
  const auto relative = [&](int axis) {
    return all(static_cast<float>(cell.centre[axis] - block.origin[axis]));
  };
  const OneInAllLanes take{lane};
  const FacetView view(
      block, take, {relative(0) + h * x_sign, relative(1) + h * y_sign, relative(2) + h * z_sign});
  *reinterpret_cast<Float8*>(sizes) =
      (take(block.start_size) + take(block.slope) * (view.distance + all(block.place_error))) *
      all(1.0f + relative_rounding);
}

// ==== Survivors

struct Collector {
  const WideTree& tree;
  Survivors& query;
  Place centre;
  float half_diagonal;

  /// False when the search is over without success.
  bool visit(std::uint32_t index, unsigned mask) {
    const WideNode& node = node_of(tree, index);
    const BoxRatios boxes(node, tree.slopes[index], query.cell, centre);
    const Float8 nearest = boxes.bounds - all(tree.slopes[index] * half_diagonal);
    mask &= bits((boxes.ratios < all(1.0f)) & (nearest < all(query.largest)));
    const Float8 edges =
        max(max(load(node.half_sizes[0]), load(node.half_sizes[1])), load(node.half_sizes[2])) *
        all(2.0f);
    const unsigned large = bits(edges > all(query.open_edge));
    unsigned kept = 0;
    for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
      const int lane = __builtin_ctz(rest);
      const std::uint32_t child = node.child[lane];
      if ((child & WideNode::is_block) != 0) {
        if (!query.open_blocks || block_survives(block_of(tree, child & ~WideNode::is_block))) {
          kept |= 1u << lane;
        }
        if (query.facets > query.most_facets) {
          return false;
        }
      } else if ((large & 1u << lane) == 0) {
        kept |= 1u << lane;
      } else if (!visit(child, all_children)) {
        return false;
      }
    }
    if (kept != 0) {
      if (query.count == query.capacity) {
        return false;
      }
      query.entries[query.count++] = index << 8 | kept;
    }
    return true;
  }

  bool block_survives(const FacetBlock& block) {
    const unsigned facets = bits(block_ratios(block, query.cell) < all(1.0f));
    query.facets += static_cast<std::uint32_t>(__builtin_popcount(facets));
    return facets != 0;
  }
};

bool survivors(const WideTree& tree, const NodeEntry* entries, int count, Survivors& query) {
  query.count = 0;
  query.facets = 0;
  Collector collector{tree, query, float_place(query.cell.centre),
                      1.7320509f * query.cell.half_edge};
  for (int i = 0; i < count; ++i) {
    if (!collector.visit(entries[i] >> 8, entries[i] & all_children)) {
      return false;
    }
  }
  return true;
}

}  // namespace

extern const TreeKernels kernels;
const TreeKernels kernels = {KERNEL_NAME, least_sizes, least_ratio, corner_sizes, survivors};

}  // namespace KERNEL_NAMESPACE
}  // namespace meshgrow::simd
