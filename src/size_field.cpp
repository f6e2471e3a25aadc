#include "size_field.h"

#include <algorithm>
#include <map>
#include <type_traits>

#include "error.h"
#include "growth_law.h"
#include "start_sizes/curvature_start_sizes.h"
#include "start_sizes/fixed_start_sizes.h"
#include "start_sizes/mesh_start_sizes.h"
#include "start_sizes/proximity_start_sizes.h"

namespace meshgrow {

SizeField::SizeField(Topology topology, FieldOptions options)
    : topology_(std::make_shared<Topology>(std::move(topology))), options_(std::move(options)) {}

std::string SizeField::function_name(std::size_t function) const {
  return meshgrow::function_name(functions_[function], function);
}

void SizeField::check_name(const std::string& name, std::size_t but_for) const {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == '"'; };
  if (name.empty() || is_number_name(name) || std::any_of(name.begin(), name.end(), is_control)) {
    throw Error("A size function cannot have the name '" + name +
                "': give one on one line that is not a number and has no quotes.");
  }
  for (std::size_t i = 0; i < functions_.size(); ++i) {
    if (i != but_for && functions_[i].name == name) {
      throw Error("There is a size function \"" + name +
                  "\" already: choose another name, or modify that one.");
    }
  }
}

std::size_t SizeField::add(SizeFunction function) {
  if (!function.name.empty()) {
    check_name(function.name, functions_.size());
  }
  const std::size_t number = numbers_given_ + 1;
  validate(function, meshgrow::function_name(function, number - 1), *topology_);
  topology_->closure(function.attachments);  // throws if a boundary is not in the model
  topology_->closure(function.sources);
  if (function.name.empty()) {
    function.name = std::to_string(number);
  }
  all_or_nothing([&] {
    functions_.push_back(std::move(function));
    facets_.emplace_back();
    facet_counts_.push_back(0);
    origins_.emplace_back();
    effective_.push_back(false);
    regroup();
    numbers_given_ = number;
  });
  return functions_.size() - 1;
}

void SizeField::modify(std::size_t function, SizeFunction definition) {
  if (definition.name.empty()) {
    definition.name = functions_[function].name;
  } else if (definition.name != functions_[function].name) {
    check_name(definition.name, function);
  }
  validate(definition, meshgrow::function_name(definition, function), *topology_);
  topology_->closure(definition.attachments);
  topology_->closure(definition.sources);
  all_or_nothing([&] {
    functions_[function] = std::move(definition);
    facets_[function] = nullptr;
    facet_counts_[function] = 0;
    origins_[function] = FacetOrigins();
    effective_[function] = false;
    mark_changed(function);
    regroup();
  });
}

void SizeField::remove(std::size_t function) {
  all_or_nothing([&] {
    const auto at = static_cast<std::ptrdiff_t>(function);
    functions_.erase(functions_.begin() + at);
    facets_.erase(facets_.begin() + at);
    facet_counts_.erase(facet_counts_.begin() + at);
    origins_.erase(origins_.begin() + at);
    effective_.erase(effective_.begin() + at);
    const auto is_removed = [function](const Action& action) {
      return action.function == function;
    };
    groups_.erase(std::remove_if(groups_.begin(), groups_.end(),
                                 [&](const Group& group) {
                                   return std::any_of(group.actions.begin(), group.actions.end(),
                                                      is_removed);
                                 }),
                  groups_.end());
    const auto move_up = [function](std::size_t& index) { index -= index > function ? 1 : 0; };
    for (Group& group : groups_) {
      for (Action& action : group.actions) {
        move_up(action.function);
      }
      move_up(group.limit.function);
      for (Origin& origin : group.origins) {
        move_up(origin.function);
      }
    }
    regroup();
  });
}

void SizeField::rename(std::size_t function, const std::string& name) {
  if (name != functions_[function].name) {
    check_name(name, function);
    functions_[function].name = name;
  }
}

std::size_t SizeField::find(const std::string& name) const {
  std::string names;
  for (std::size_t i = 0; i < functions_.size(); ++i) {
    if (functions_[i].name == name) {
      return i;
    }
    names += (i == 0 ? "\"" : ", \"") + functions_[i].name + '"';
  }
  throw Error("There is no size function \"" + name +
              "\": " + (names.empty() ? "add one first." : "give one of " + names + "."));
}

template <typename Body>
void SizeField::all_or_nothing(Body body) {
  static_assert(std::is_nothrow_move_assignable_v<SizeField>);
  SizeField before = *this;
  try {
    body();
  } catch (...) {
    *this = std::move(before);
    throw;
  }
}

void SizeField::regroup() {
  std::map<Entity, std::vector<Action>> actions_on;
  for (std::size_t i = 0; i < functions_.size(); ++i) {
    std::vector<Entity> source_volumes;
    for (const Entity& source : functions_[i].sources) {
      if (source.dim == 3 && functions_[i].kind == Kind::fixed) {
        source_volumes.push_back(source);
      }
    }
    const std::set<Entity> inside = topology_->closure(source_volumes);
    for (const Entity& entity : topology_->closure(functions_[i].attachments)) {
      actions_on[entity].push_back({i, inside.count(entity) > 0});
    }
  }
  std::map<std::vector<Action>, std::size_t> index_of;
  std::vector<Group> groups;
  std::unordered_map<Entity, std::size_t, EntityHash> group_of;
  for (const auto& [entity, actions] : actions_on) {
    const auto [found, is_new] = index_of.emplace(actions, groups.size());
    if (is_new) {
      groups.emplace_back();
      groups.back().actions = actions;
    }
    groups[found->second].entities.push_back(entity);
    group_of[entity] = found->second;
  }
  // Groups on which the same functions act as before keep what is built.
  for (Group& old : groups_) {
    const auto found = index_of.find(old.actions);
    if (found != index_of.end()) {
      Group& group = groups[found->second];
      old.changed = old.changed || old.entities != group.entities;
      old.entities = std::move(group.entities);
      group = std::move(old);
    }
  }
  groups_ = std::move(groups);
  group_of_ = std::move(group_of);
}

DroppedFacets SizeField::set_sources(std::size_t function,
                                     const std::vector<FacetedSource>& sources, double unit) {
  const SizeFunction& definition = functions_[function];
  const double slope = growth_slope(definition.growth_rate);
  SizedFacets facets;
  FacetOrigins origins;
  DroppedFacets dropped;
  for (const FacetedSource& source : sources) {
    origins.begin(facets.size(), source.entity);
    if (definition.kind == Kind::mesh) {
      dropped += append_mesh_start_sizes(source, definition.quad_size, slope, facets);
    } else if (definition.kind == Kind::fixed) {
      dropped += append_fixed_start_sizes(source, definition.start_size, slope, facets);
    } else {
      dropped += append_curvature_start_sizes(
          source, {definition.angle, definition.min_size, definition.size_limit}, slope, facets);
    }
  }
  if (definition.kind == Kind::mesh) {
    for (SizedFacet& facet : facets) {
      facet.start_size /= unit;
    }
  }
  set_facets(function, std::move(facets), std::move(origins));
  return dropped;
}

void SizeField::set_regions(std::size_t function, const std::vector<WalledRegion>& regions) {
  const SizeFunction& definition = functions_[function];
  const ProximityParameters parameters = {definition.cells_per_gap, definition.growth_rate,
                                          definition.size_limit, definition.min_size,
                                          options_.threads};
  SizedFacets facets;
  FacetOrigins origins;
  for (const WalledRegion& region : regions) {
    append_proximity_start_sizes(region.walls, region.gaps.sources, parameters, facets, &origins);
  }
  set_facets(function, std::move(facets), std::move(origins));
}

void SizeField::set_facets(std::size_t function, SizedFacets facets, FacetOrigins origins) {
  const Kind kind = functions_[function].kind;
  const bool needs_facets = kind == Kind::mesh || kind == Kind::fixed;
  const bool effective = !needs_facets || !facets.empty();
  const std::shared_ptr<const SizedFacets>& before = facets_[function];
  const bool same_facets = before ? facets == *before : facets.empty();
  if (same_facets && effective == effective_[function]) {
    return;  // trees and grids are good as they are
  }
  const std::size_t count = facets.size();
  facets_[function] = std::make_shared<const SizedFacets>(std::move(facets));
  facet_counts_[function] = count;
  origins_[function] = std::move(origins);
  effective_[function] = effective;
  mark_changed(function);
}

void SizeField::mark_changed(std::size_t function) {
  for (Group& group : groups_) {
    for (const Action& action : group.actions) {
      group.changed = group.changed || action.function == function;
    }
  }
}

}  // namespace meshgrow
