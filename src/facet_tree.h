#ifndef MESHGROW_FACET_TREE_H
#define MESHGROW_FACET_TREE_H

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "simd/tree_kernels.h"
#include "sized_facets.h"
#include "tree_layout.h"

namespace meshgrow {

/// Bounding volume hierarchy over sized facets, eight children a node. Each node carries the
/// smallest start size and the smallest slope below it, so a best-first descent finds the exact
/// minimum of S0 + α · distance over **all** facets, not only over the nearest one (DESIGN.md,
/// section 2).
///
/// Immutable after construction; every const function may be called from any thread.
class FacetTree {
 public:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// Takes the facets over and reorders them. An empty set is allowed: every size is then infinite.
  /// `threads` build (0: OMP_NUM_THREADS, else all processors); the result does not depend on it.
  explicit FacetTree(SizedFacets facets, int threads = 1);

  /// Takes over what another tree has stored.
  explicit FacetTree(StoredTree stored) : stored_(std::move(stored)) {}
  const StoredTree& stored() const { return stored_; }

  /// Minimum over all facets of S0 + α · distance(p), or `upper_bound` where no facet is below it.
  /// p must be finite; model units. Float rules facets out, double decides among the rest.
  double size(const Vec3& p, double upper_bound = infinity) const;

  /// The same for many points, in less time each.
  void sizes(const Vec3* points, std::size_t count, double upper_bound, double* sizes) const;

  /// Every facet is below it.
  static constexpr simd::NodeEntry root = simd::all_children;

  /// The parts of the tree in which to look.
  struct Entries {
    const simd::NodeEntry* begin = &root;
    int count = 1;
  };

  struct Smallest {
    static constexpr std::uint32_t no_facet = 0xFFFFFFFFu;
    double size = infinity;          ///< model units
    std::uint32_t facet = no_facet;  ///< index into facets(); of equal ones the first
  };

  /// The smallest among the facets below `entries`, if it is below that of `known`: this is where
  /// the search begins, and what is answered otherwise.
  Smallest smallest(const Vec3& p, const Entries& entries, const Smallest& known) const;

  /// The same size to 1e-5, from above but for its last digits, in less time: where float is good
  /// enough for that, it is not asked for more. `upper_bound` where nothing is below it.
  double fast_size(const Vec3& p, const Entries& entries, double upper_bound) const;

  /// Where to find a facet alone, or nearly so.
  simd::NodeEntry entry_of(std::uint32_t facet) const {
    return stored_.block_entries[facet / simd::lanes];
  }

  /// The same for several points, in less time each. `known` on entry, the answers on return;
  /// entries(i) are those for point i.
  template <typename EntriesOf>
  void smallest(const Vec3* points, std::size_t count, EntriesOf entries, Smallest* known) const;

  /// The same with sizes as of `fast_size`; the facets are not told.
  template <typename EntriesOf>
  void fast_smallest(const Vec3* points, std::size_t count, EntriesOf entries,
                     Smallest* known) const;

  struct Closest {
    std::size_t facet = 0;       ///< index into facets()
    double distance = infinity;  ///< model units; infinite when the tree is empty
  };

  /// The facet nearest to the finite point p, whatever its start size.
  Closest closest_facet(const Vec3& p) const;

  /// The facet nearest to p among those for which `distance_to(i)`, with i an index into facets(),
  /// gives a distance below `within`: its true distance from p, or more to leave it out.
  template <typename DistanceTo>
  Closest closest_facet(const Vec3& p, double within, DistanceTo distance_to) const {
    return best_first(
        within, [&p](std::size_t, const Box& box) { return box.exteriorDistance(p); }, distance_to);
  }

  /// The same among the facets below nodes for which `distance_to_node(node, box)` gives a distance
  /// below `within`: a lower bound of what `distance_to` gives for each facet below the node, and
  /// in the box. Nodes are numbered as in node_values().
  template <typename DistanceToNode, typename DistanceTo>
  Closest closest_facet(double within, DistanceToNode distance_to_node,
                        DistanceTo distance_to) const {
    return best_first(within, distance_to_node, distance_to);
  }

  /// What `merge(value, other)` makes of the values of all facets below each node, one value a
  /// node, the first for all facets.
  template <typename Value, typename OfFacet, typename Merge>
  std::vector<Value> node_values(OfFacet of_facet, Merge merge) const;

  /// The first triangle that the ray from `origin` along the unit vector `direction` meets at a
  /// distance below `within`, among those that `accepts(i)`, with i an index into facets().
  template <typename Accepts>
  Closest first_hit(const Vec3& origin, const Vec3& direction, double within,
                    Accepts accepts) const {
    const Vec3 inverse = direction.cwiseInverse();
    return best_first(
        within, [&](std::size_t, const Box& box) { return ray_enters(box, origin, inverse); },
        [&](std::uint32_t i) {
          const double hit = ray_distance(stored_.facets[i].facet, origin, direction);
          return hit < infinity && accepts(i) ? hit : infinity;
        });
  }

  /// Distance at which the ray enters the box: 0 from inside, infinite where it misses. A
  /// coordinate of the inverse direction is infinite where the direction has none.
  static double ray_enters(const Box& box, const Vec3& origin, const Vec3& inverse_direction);

  /// The facets in the tree's own order, neighbours in space near each other.
  const StoredArray<SizedFacet>& facets() const { return stored_.facets; }

  /// Where facets()[i] stood in the set that the tree was made from.
  std::size_t original_index(std::size_t i) const { return stored_.order[i]; }

  bool empty() const { return stored_.facets.empty(); }
  std::size_t memory_bytes() const;

  /// For kernels: lengths in units of `unit()`, places relative to `centre()`.
  simd::WideTree view() const;
  const simd::FacetBlock& block_of(std::uint32_t facet) const {
    return stored_.blocks[facet / simd::lanes];
  }
  double unit() const { return stored_.unit; }
  const Vec3& centre() const { return stored_.centre; }
  double largest_slope() const { return stored_.largest_slope; }
  /// Of all facets, rounded down a little, model units; infinite without facets.
  double smallest_start_size() const;
  /// Farther away, or with facets so far apart that the smallest are nothing in float beside that,
  /// float cannot rule anything out, and only `size` and `sizes` may be asked.
  bool is_near_enough_for_float(const Vec3& p) const;

 private:
  struct Search {
    const FacetTree* tree;
    const Vec3* p;
    Smallest* best;
    simd::LeastSize* query;

    void begin(const Entries& entries);
    float limit() const;
    void decide();
    void decide_if_needed();
  };

  /// Searches begun together.
  static constexpr std::size_t searches_at_once = 8;

  template <std::size_t group, typename EntriesOf, typename Finish>
  void search(const Vec3* points, std::size_t count, EntriesOf entries, Smallest* known,
              Finish finish) const;
  void run(simd::LeastSize* queries, std::size_t count) const;

  /// Entries of a stack that holds up to seven siblings a level, of eleven levels.
  static constexpr std::size_t stack_size = 96;

  Box child_box(std::uint32_t node, int lane) const;
  double reference_size(const Vec3& p, double upper_bound) const;

  template <typename LowerBound, typename FacetValue>
  Closest best_first(double upper_bound, LowerBound lower_bound, FacetValue value) const;

  StoredTree stored_;
};

template <std::size_t group, typename EntriesOf, typename Finish>
void FacetTree::search(const Vec3* points, std::size_t count, EntriesOf entries, Smallest* known,
                       Finish finish) const {
  if (empty()) {
    return;
  }
  std::array<simd::LeastSize, group> queries;
  std::array<Search, group> searches;
  for (std::size_t first = 0; first < count; first += group) {
    const std::size_t in_group = std::min(group, count - first);
    for (std::size_t i = 0; i < in_group; ++i) {
      searches[i] = {this, points + first + i, known + first + i, &queries[i]};
      searches[i].begin(entries(first + i));
    }
    run(queries.data(), in_group);
    for (std::size_t i = 0; i < in_group; ++i) {
      finish(searches[i]);
    }
  }
}

template <typename EntriesOf>
void FacetTree::smallest(const Vec3* points, std::size_t count, EntriesOf entries,
                         Smallest* known) const {
  search<searches_at_once>(points, count, entries, known, [](Search& one) { one.decide(); });
}

template <typename EntriesOf>
void FacetTree::fast_smallest(const Vec3* points, std::size_t count, EntriesOf entries,
                              Smallest* known) const {
  search<searches_at_once>(points, count, entries, known,
                           [](Search& one) { one.decide_if_needed(); });
}

template <typename Value, typename OfFacet, typename Merge>
std::vector<Value> FacetTree::node_values(OfFacet of_facet, Merge merge) const {
  if (empty()) {
    return {};
  }
  // The first is for all; child k of node n is 1 + 8 n + k, and holds no value where there is none.
  std::vector<Value> values(1 + stored_.nodes.size() * simd::lanes);
  for (std::size_t n = stored_.nodes.size(); n-- > 0;) {  // children come after their parents
    const simd::WideNode& node = stored_.nodes[n];
    for (int lane = 0; lane < simd::lanes && node.start_size[lane] < infinity; ++lane) {
      Value& value = values[1 + n * simd::lanes + lane];
      const std::uint32_t child = node.child[lane];
      if ((child & simd::WideNode::is_block) != 0) {
        const simd::FacetBlock& block = stored_.blocks[child & ~simd::WideNode::is_block];
        value = of_facet(block.first);
        for (std::uint32_t k = 1; k < block.count; ++k) {
          merge(value, of_facet(block.first + k));
        }
      } else {
        const std::size_t first = 1 + static_cast<std::size_t>(child) * simd::lanes;
        value = values[first];
        const simd::WideNode& below = stored_.nodes[child];
        for (int k = 1; k < simd::lanes && below.start_size[k] < infinity; ++k) {
          merge(value, values[first + k]);
        }
      }
    }
  }
  values[0] = values[1];
  for (int k = 1; k < simd::lanes && stored_.nodes[0].start_size[k] < infinity; ++k) {
    merge(values[0], values[1 + k]);
  }
  return values;
}

template <typename LowerBound, typename FacetValue>
FacetTree::Closest FacetTree::best_first(double upper_bound, LowerBound lower_bound,
                                         FacetValue value) const {
  struct Entry {
    double bound;
    std::uint32_t child;
  };
  Closest best{stored_.facets.size(), upper_bound};
  if (stored_.nodes.empty() || !(lower_bound(0, stored_.box) < best.distance)) {
    return best;
  }
  std::array<Entry, stack_size> stack;
  std::size_t top = 0;
  stack[top++] = {-infinity, 0};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (!(entry.bound < best.distance)) {
      continue;
    }
    if ((entry.child & simd::WideNode::is_block) != 0) {
      const simd::FacetBlock& block = stored_.blocks[entry.child & ~simd::WideNode::is_block];
      for (std::uint32_t i = block.first; i < block.first + block.count; ++i) {
        const double candidate = value(i);
        if (candidate < best.distance) {
          best = {i, candidate};
        }
      }
      continue;
    }
    const simd::WideNode& node = stored_.nodes[entry.child];
    const std::size_t first = top;
    for (int lane = 0; lane < simd::lanes && node.start_size[lane] < infinity; ++lane) {
      const Entry child{lower_bound(1 + static_cast<std::size_t>(entry.child) * simd::lanes + lane,
                                    child_box(entry.child, lane)),
                        node.child[lane]};
      if (child.bound < best.distance) {
        std::size_t place = top++;
        for (; place > first && stack[place - 1].bound < child.bound; --place) {
          stack[place] = stack[place - 1];
        }
        stack[place] = child;
      }
    }
  }
  return best;
}

}  // namespace meshgrow

#endif
