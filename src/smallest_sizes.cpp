// What SizeField answers to who knows no entity: the smallest size of all groups.

#include <algorithm>
#include <array>

#include "size_field.h"

namespace meshgrow {

namespace {

/// Numbers that tell facets apart.
std::array<double, 12> key_of(const SizedFacet& facet) {
  std::array<double, 12> key;
  for (int i = 0; i < 9; ++i) {
    key[i] = facet.facet.corners[i / 3][i % 3];
  }
  key[9] = facet.facet.corner_count;
  key[10] = facet.start_size;
  key[11] = facet.slope;
  return key;
}

/// Functions that act on several groups have their facets in each of their trees.
void keep_one_of_each(SizedFacets& facets) {
  std::sort(facets.begin(), facets.end(),
            [](const SizedFacet& a, const SizedFacet& b) { return key_of(a) < key_of(b); });
  facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
}

}  // namespace

/// Where the group may be asked by who does not know the entity: a group inside a source volume
/// takes every point to be in there.
Box SizeField::reach_of(const Group& group) const {
  if (std::none_of(group.actions.begin(), group.actions.end(),
                   [](const Action& action) { return action.inside_source; })) {
    return Box(Vec3::Constant(-no_size), Vec3::Constant(no_size));
  }
  const Box box = box_of(group);
  if (box.isEmpty()) {
    return box;
  }
  // The boxes of bent surfaces may be a little too small.
  const Vec3 more = Vec3::Constant(0.01 * box.diagonal().norm());
  return Box(box.min() - more, box.max() + more);
}

void SizeField::smallest_sizes(const Vec3* points, std::size_t count, double* sizes,
                               std::size_t* groups) const {
  std::fill(sizes, sizes + count, no_size);
  if (groups != nullptr) {
    std::fill(groups, groups + count, 0);
  }
  std::vector<double> of_group(count);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Box reach = reach_of(groups_[g]);
    this->sizes(groups_[g].entities.front(), points, count, of_group.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (of_group[i] < sizes[i] && reach.contains(points[i])) {
        sizes[i] = of_group[i];
        if (groups != nullptr) {
          groups[i] = g;
        }
      }
    }
  }
}

SizeField::Answering SizeField::answering(const Entity& entity) const {
  Answering result;
  const Group* found = group(entity);
  if (found != nullptr && found->tree) {
    result.tree = found->tree;
    result.size_limit = found->size_limit;
    result.box = box_of(*found);
    result.grid = found->grid;
    result.group = static_cast<std::size_t>(found - groups_.data());
  }
  return result;
}

SizeField::Answering SizeField::answering_together() const {
  std::vector<const Group*> built;
  for (const Group& group : groups_) {
    if (group.tree && group.size_limit < no_size) {
      built.push_back(&group);
    }
  }
  Answering result;
  if (built.size() == 1) {
    result = answering(built.front()->entities.front());
  } else if (built.size() > 1) {
    SizedFacets facets;
    for (const Group* group : built) {
      const auto& more = group->tree->facets();
      facets.insert(facets.end(), more.begin(), more.end());
      if (group->limit.inside_source) {
        result.inside.emplace_back(reach_of(*group), group->size_limit);
      } else {
        result.size_limit = std::min(result.size_limit, group->size_limit);
      }
    }
    keep_one_of_each(facets);
    const int threads = threads_for(facets.size());
    result.tree = std::make_shared<FacetTree>(std::move(facets), threads);
  }
  const Box of_group = result.box;
  for (const Entity& entity : topology_->entities()) {
    result.box.extend(topology_->box(entity));
  }
  if (!of_group.contains(result.box)) {
    result.grid = nullptr;
  }
  return result;
}

}  // namespace meshgrow
