#include "facet_tree.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "error.h"

namespace meshgrow {

namespace {

/// Of sizes in float, generously.
constexpr double relative_rounding = 4e-6;

/// In units of the tree. Squares of what is farther may not be finite in float.
constexpr double farthest_for_float = 1e15;

}  // namespace

FacetTree::FacetTree(SizedFacets facets, int threads) {
  if (facets.size() > std::numeric_limits<std::uint32_t>::max() / 2) {
    throw Error("A size function has more than 2 billion facets: split its sources.");
  }
  if (facets.empty()) {
    return;
  }
  facets_ = std::move(facets);
  layout_ = layout_tree(facets_, threads);
  for (const SizedFacet& facet : facets_) {
    largest_slope_ = std::max(largest_slope_, facet.slope);
  }
}

Box FacetTree::child_box(std::uint32_t node, int lane) const {
  const WideBoxes& boxes = layout_.boxes[node];
  const Vec3 lower(boxes.lower[0][lane], boxes.lower[1][lane], boxes.lower[2][lane]);
  const Vec3 upper(boxes.upper[0][lane], boxes.upper[1][lane], boxes.upper[2][lane]);
  return Box(layout_.centre + layout_.unit * lower, layout_.centre + layout_.unit * upper);
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

/// One search: takes candidates from the kernel and decides in double.
struct FacetTree::Search {
  const FacetTree* tree;
  const Vec3* p;
  Smallest* best;
  simd::LeastSize* query;

  void begin() {
    const Vec3 place = (*p - tree->layout_.centre) / tree->layout_.unit;
    for (int axis = 0; axis < 3; ++axis) {
      query->place[axis] = place[axis];
    }
    query->limit = limit();
    query->count = 0;
    query->context = this;
    query->overflow = [](simd::LeastSize& full) { static_cast<Search*>(full.context)->decide(); };
  }

  float limit() const {
    const double scaled = best->size / tree->layout_.unit * (1.0 + relative_rounding);
    return scaled < FLT_MAX ? static_cast<float>(scaled) : FLT_MAX;
  }

  void decide() {
    for (int i = 0; i < query->count; ++i) {
      if (query->lower_bounds[i] <= query->limit) {
        const std::uint32_t facet = query->facets[i];
        const double size = tree->facets_[facet].size_at(*p);
        if (size < best->size || (size == best->size && facet < best->facet)) {
          *best = {size, facet};
        }
      }
    }
    query->count = 0;
    query->limit = std::min(query->limit, limit());
  }
};

FacetTree::Smallest FacetTree::smallest(const Vec3& p, const simd::NodeEntry* entries, int count,
                                        const Smallest& known) const {
  Smallest best = known;
  smallest(&p, 1, entries, count, &best);
  return best;
}

void FacetTree::smallest(const Vec3* points, std::size_t point_count,
                         const simd::NodeEntry* entries, int count, Smallest* known) const {
  if (empty()) {
    return;
  }
  static const simd::TreeKernels& kernels = simd::tree_kernels();
  constexpr std::size_t group = 8;
  std::array<simd::LeastSize, group> queries;
  std::array<Search, group> searches;
  for (std::size_t first = 0; first < point_count; first += group) {
    const std::size_t in_group = std::min(group, point_count - first);
    for (std::size_t i = 0; i < in_group; ++i) {
      searches[i] = {this, points + first + i, known + first + i, &queries[i]};
      searches[i].begin();
    }
    kernels.least_sizes(view(), entries, count, queries.data(), static_cast<int>(in_group));
    for (std::size_t i = 0; i < in_group; ++i) {
      searches[i].decide();
    }
  }
}

double FacetTree::size(const Vec3& p, double upper_bound) const {
  if (!is_near_enough_for_float(p)) {
    return reference_size(p, upper_bound);
  }
  return smallest(p, &root, 1, {upper_bound, Smallest::no_facet}).size;
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
      smallest(begin, in_group, &root, 1, found.data());
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

bool FacetTree::is_near_enough_for_float(const Vec3& p) const {
  return (p - layout_.centre).cwiseAbs().maxCoeff() < farthest_for_float * layout_.unit;
}

double FacetTree::reference_size(const Vec3& p, double upper_bound) const {
  return best_first(
             upper_bound, [](std::size_t, const Box&) { return 0.0; },
             [&](std::uint32_t i) { return facets_[i].size_at(p); })
      .distance;
}

FacetTree::Closest FacetTree::closest_facet(const Vec3& p) const {
  return closest_facet(p, infinity, [&](std::uint32_t i) { return distance(facets_[i].facet, p); });
}

std::size_t FacetTree::memory_bytes() const {
  return facets_.capacity() * sizeof(SizedFacet) +
         layout_.order.capacity() * sizeof(layout_.order[0]) +
         layout_.nodes.capacity() * (sizeof(simd::WideNode) + sizeof(WideBoxes) + sizeof(float)) +
         layout_.blocks.capacity() * sizeof(simd::FacetBlock);
}

}  // namespace meshgrow
