#ifndef MESHGROW_FACET_TREE_H
#define MESHGROW_FACET_TREE_H

#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "sized_facets.h"

namespace meshgrow {

/// Bounding volume hierarchy over sized facets. Each node carries the smallest start size and the
/// smallest slope below it, so a best-first descent finds the exact minimum of S0 + α · distance
/// over
/// **all** facets, not only over the nearest one (DESIGN.md, section 2).
///
/// Immutable after construction; every const function may be called from any thread.
class FacetTree {
 public:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// Takes the facets over and reorders them. An empty set is allowed: every size is then infinite.
  explicit FacetTree(SizedFacets facets);

  /// Minimum over all facets of S0 + α · distance(p), or `upper_bound` where no facet is below it.
  /// p must be finite; model units.
  double size(const Vec3& p, double upper_bound = infinity) const;

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
        within, [&p](const Node& node) { return node.box.exteriorDistance(p); }, distance_to);
  }

  /// The same among the facets below nodes for which `distance_to_node(node, box)` gives a distance
  /// below `within`: a lower bound of what `distance_to` gives for each facet below the node, and
  /// in the box. Nodes are numbered as in node_values().
  template <typename DistanceToNode, typename DistanceTo>
  Closest closest_facet(double within, DistanceToNode distance_to_node,
                        DistanceTo distance_to) const {
    return best_first(
        within,
        [&](const Node& node) {
          return distance_to_node(static_cast<std::size_t>(&node - nodes_.data()), node.box);
        },
        distance_to);
  }

  /// What `merge(value, other)` makes of the values of all facets below each node, one value a
  /// node, the first for all facets.
  template <typename Value, typename OfFacet, typename Merge>
  std::vector<Value> node_values(OfFacet of_facet, Merge merge) const {
    std::vector<Value> values(nodes_.size());
    for (std::size_t i = nodes_.size(); i-- > 0;) {  // children come after their parents
      const Node& node = nodes_[i];
      values[i] = node.count > 0 ? of_facet(node.first) : values[node.first];
      for (std::uint32_t k = 1; k < node.count; ++k) {
        merge(values[i], of_facet(node.first + k));
      }
      if (node.count == 0) {
        merge(values[i], values[node.first + 1]);
      }
    }
    return values;
  }

  /// The first triangle that the ray from `origin` along the unit vector `direction` meets at a
  /// distance below `within`, among those that `accepts(i)`, with i an index into facets().
  template <typename Accepts>
  Closest first_hit(const Vec3& origin, const Vec3& direction, double within,
                    Accepts accepts) const {
    const Vec3 inverse = direction.cwiseInverse();
    return best_first(
        within, [&](const Node& node) { return ray_enters(node.box, origin, inverse); },
        [&](std::uint32_t i) {
          const double hit = ray_distance(facets_[i].facet, origin, direction);
          return hit < infinity && accepts(i) ? hit : infinity;
        });
  }

  /// Distance at which the ray enters the box: 0 from inside, infinite where it misses. A
  /// coordinate of the inverse direction is infinite where the direction has none.
  static double ray_enters(const Box& box, const Vec3& origin, const Vec3& inverse_direction);

  /// The facets in the tree's own order, neighbours in space near each other.
  const SizedFacets& facets() const { return facets_; }

  /// Where facets()[i] stood in the set that the tree was made from.
  std::size_t original_index(std::size_t i) const { return original_index_[i]; }

  bool empty() const { return facets_.empty(); }
  std::size_t memory_bytes() const;

 private:
  struct Node {
    Box box;
    double min_start_size;
    double min_slope;
    std::uint32_t
        first;  ///< first facet of a leaf, else index of the first of two adjacent children
    std::uint32_t count;  ///< facets of a leaf, 0 for an inner node
  };

  /// Median splits halve the facets, so 2^32 facets need 32 levels; one entry a level stays behind.
  static constexpr std::size_t stack_size = 64;

  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count,
             const SizedFacets& facets, const std::vector<Vec3>& centroids);

  template <typename LowerBound, typename FacetValue>
  Closest best_first(double upper_bound, LowerBound lower_bound, FacetValue value) const;

  SizedFacets facets_;
  std::vector<std::uint32_t> original_index_;
  std::vector<Node> nodes_;
};

template <typename LowerBound, typename FacetValue>
FacetTree::Closest FacetTree::best_first(double upper_bound, LowerBound lower_bound,
                                         FacetValue value) const {
  struct Entry {
    double bound;
    std::uint32_t node;
  };
  Closest best{facets_.size(), upper_bound};
  if (nodes_.empty()) {
    return best;
  }
  std::array<Entry, stack_size> stack;
  std::size_t top = 0;
  stack[top++] = {lower_bound(nodes_[0]), 0};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (!(entry.bound < best.distance)) {
      continue;
    }
    const Node& node = nodes_[entry.node];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const double candidate = value(i);
      if (candidate < best.distance) {
        best = {i, candidate};
      }
    }
    if (node.count == 0) {
      Entry near{lower_bound(nodes_[node.first]), node.first};
      Entry far{lower_bound(nodes_[node.first + 1]), node.first + 1};
      if (far.bound < near.bound) {
        std::swap(near, far);
      }
      stack[top++] = far;
      stack[top++] = near;
    }
  }
  return best;
}

}  // namespace meshgrow

#endif
