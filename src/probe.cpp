#include "probe.h"

#include <algorithm>
#include <tuple>

#include "size_field.h"

namespace meshgrow {

namespace {

/// The facet that asks for the smallest size, if that is not above the limit.
FacetTree::Smallest smallest_facet(const FacetTree& tree, const Vec3& p, double limit) {
  FacetTree::Smallest found{limit, FacetTree::Smallest::no_facet};
  if (tree.empty()) {
    return found;
  }
  if (tree.is_near_enough_for_float(p)) {
    return tree.smallest(p, FacetTree::Entries(), found);
  }
  for (std::size_t i = 0; i < tree.facets().size(); ++i) {
    const double size = tree.facets()[i].size_at(p);
    if (size < found.size) {
      found = {size, static_cast<std::uint32_t>(i)};
    }
  }
  return found;
}

}  // namespace

Probe SizeField::probe(const Entity& entity, const Vec3& p) const {
  Probe result;
  result.entity = entity;
  const Group* found = group(entity);
  if (found == nullptr || !found->tree || !p.allFinite()) {
    return result;
  }
  result.exact_size = found->tree->size(p, found->size_limit);
  if (found->grid) {
    bool interpolated = false;
    result.grid_size = found->grid->size(p, interpolated);
  }
  result.size = found->grid ? result.grid_size : result.exact_size;
  if (!(found->size_limit < no_size)) {
    return result;  // no function has an effect
  }
  const FacetTree::Smallest smallest = smallest_facet(*found->tree, p, found->size_limit);
  if (smallest.facet == FacetTree::Smallest::no_facet) {
    result.rule = found->limit.inside_source ? Rule::inside_source : Rule::limit;
    result.function = found->limit.function;
    return result;
  }
  result.rule = Rule::facet;
  result.facet = found->tree->facets()[smallest.facet];
  result.distance = distance(result.facet.facet, p);
  const std::size_t place = found->tree->original_index(smallest.facet);
  const auto origin = std::prev(std::upper_bound(
      found->origins.begin(), found->origins.end(), place,
      [](std::size_t index, const Origin& stretch) { return index < stretch.first_facet; }));
  result.function = origin->function;
  result.source = origin->entities.entity_of(place - origin->first_facet);
  return result;
}

Probe SizeField::probe(const Vec3& p) const {
  const auto is_around = [&](const Entity& entity) { return topology_->box(entity).contains(p); };
  Probe best;
  for (const Group& group : groups_) {
    if (!reach_of(group).contains(p)) {
      continue;
    }
    // The highest entity of the group that may hold the point stands for all.
    const auto around = std::find_if(group.entities.rbegin(), group.entities.rend(), is_around);
    const Entity& entity = around == group.entities.rend() ? group.entities.back() : *around;
    const Probe one = probe(entity, p);
    const auto key = [&](const Probe& probe) {
      return std::make_tuple(probe.size, !is_around(probe.entity), -probe.entity.dim);
    };
    if (one.rule != Rule::nothing && (best.rule == Rule::nothing || key(one) < key(best))) {
      best = one;
    }
  }
  return best;
}

}  // namespace meshgrow
