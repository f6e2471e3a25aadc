#include "facet_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "error.h"

namespace meshgrow {

namespace {

constexpr std::uint32_t facets_per_leaf = 4;

/// Median splits halve the facets, so 2^32 facets need 32 levels; one entry a level stays behind.
constexpr std::size_t stack_size = 64;

}  // namespace

FacetTree::FacetTree(SizedFacets facets) : facets_(std::move(facets)) {
  if (facets_.size() > std::numeric_limits<std::uint32_t>::max() / 2) {
    throw Error("A size function has more than 2 billion facets: split its sources.");
  }
  if (!facets_.empty()) {
    nodes_.reserve(facets_.size());
    nodes_.emplace_back();
    build(0, 0, static_cast<std::uint32_t>(facets_.size()));
    nodes_.shrink_to_fit();
  }
}

void FacetTree::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  Box box;
  Box centroids;
  double min_start_size = infinity;
  double min_slope = infinity;
  for (std::uint32_t i = first; i < first + count; ++i) {
    box.extend(facets_[i].facet.box());
    centroids.extend(facets_[i].facet.centroid());
    min_start_size = std::min(min_start_size, facets_[i].start_size);
    min_slope = std::min(min_slope, facets_[i].slope);
  }
  if (count <= facets_per_leaf) {
    nodes_[node] = {box, min_start_size, min_slope, first, count};
    return;
  }
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node] = {box, min_start_size, min_slope, children, 0};
  nodes_.resize(nodes_.size() + 2);
  int axis = 0;
  centroids.sizes().maxCoeff(&axis);
  const std::uint32_t half = count / 2;
  const auto begin = facets_.begin() + first;
  std::nth_element(begin, begin + half, begin + count,
                   [axis](const SizedFacet& a, const SizedFacet& b) {
                     return a.facet.centroid()[axis] < b.facet.centroid()[axis];
                   });
  build(children, first, half);
  build(children + 1, first + half, count - half);
}

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
      const double candidate = value(facets_[i]);
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

double FacetTree::size(const Vec3& p, double upper_bound) const {
  return best_first(
             upper_bound,
             [&p](const Node& node) {
               return node.min_start_size + node.min_slope * node.box.exteriorDistance(p);
             },
             [&p](const SizedFacet& facet) { return facet.size_at(p); })
      .distance;
}

FacetTree::Closest FacetTree::closest_facet(const Vec3& p) const {
  return best_first(
      infinity, [&p](const Node& node) { return node.box.exteriorDistance(p); },
      [&p](const SizedFacet& facet) { return distance(facet.facet, p); });
}

std::size_t FacetTree::memory_bytes() const {
  return nodes_.capacity() * sizeof(Node) + facets_.capacity() * sizeof(SizedFacet);
}

}  // namespace meshgrow
