#include "facet_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "error.h"

namespace meshgrow {

namespace {

constexpr std::uint32_t facets_per_leaf = 4;

}  // namespace

FacetTree::FacetTree(SizedFacets facets) {
  if (facets.size() > std::numeric_limits<std::uint32_t>::max() / 2) {
    throw Error("A size function has more than 2 billion facets: split its sources.");
  }
  if (facets.empty()) {
    return;
  }
  std::vector<Vec3> centroids;
  centroids.reserve(facets.size());
  for (const SizedFacet& facet : facets) {
    centroids.push_back(facet.facet.centroid());
  }
  original_index_.resize(facets.size());
  std::iota(original_index_.begin(), original_index_.end(), 0U);
  nodes_.reserve(facets.size());
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(facets.size()), facets, centroids);
  nodes_.shrink_to_fit();
  facets_.reserve(facets.size());
  for (const std::uint32_t original : original_index_) {
    facets_.push_back(facets[original]);
  }
}

void FacetTree::build(std::uint32_t node, std::uint32_t first, std::uint32_t count,
                      const SizedFacets& facets, const std::vector<Vec3>& centroids) {
  Box box;
  Box centroid_box;
  double min_start_size = infinity;
  double min_slope = infinity;
  const auto begin = original_index_.begin() + first;
  for (auto i = begin; i != begin + count; ++i) {
    box.extend(facets[*i].facet.box());
    centroid_box.extend(centroids[*i]);
    min_start_size = std::min(min_start_size, facets[*i].start_size);
    min_slope = std::min(min_slope, facets[*i].slope);
  }
  if (count <= facets_per_leaf) {
    nodes_[node] = {box, min_start_size, min_slope, first, count};
    return;
  }
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node] = {box, min_start_size, min_slope, children, 0};
  nodes_.resize(nodes_.size() + 2);
  int axis = 0;
  centroid_box.sizes().maxCoeff(&axis);
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, begin + count,
                   [axis, &centroids](std::uint32_t a, std::uint32_t b) {
                     return centroids[a][axis] < centroids[b][axis];
                   });
  build(children, first, half, facets, centroids);
  build(children + 1, first + half, count - half, facets, centroids);
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

double FacetTree::size(const Vec3& p, double upper_bound) const {
  return best_first(
             upper_bound,
             [&p](const Node& node) {
               return node.min_start_size + node.min_slope * node.box.exteriorDistance(p);
             },
             [&](std::uint32_t i) { return facets_[i].size_at(p); })
      .distance;
}

FacetTree::Closest FacetTree::closest_facet(const Vec3& p) const {
  return closest_facet(p, infinity, [&](std::uint32_t i) { return distance(facets_[i].facet, p); });
}

std::size_t FacetTree::memory_bytes() const {
  return nodes_.capacity() * sizeof(Node) + facets_.capacity() * sizeof(SizedFacet) +
         original_index_.capacity() * sizeof(std::uint32_t);
}

}  // namespace meshgrow
