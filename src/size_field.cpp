#include "size_field.h"

#include <algorithm>
#include <map>
#include <type_traits>

#include "error.h"
#include "expected_elements.h"
#include "growth_law.h"
#include "number_text.h"
#include "parallel.h"
#include "start_sizes/curvature_start_sizes.h"
#include "start_sizes/fixed_start_sizes.h"
#include "start_sizes/mesh_start_sizes.h"
#include "start_sizes/proximity_start_sizes.h"
#include "stop_watch.h"

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

// ==== Trees and grids

namespace {

/// A grid takes about so many times longer to build, a facet, than it saves at a size: 2.5 µs on
/// one thread against 0.5 µs (tests/run_benchmarks.sh). A little more, so that it never loses.
constexpr double sizes_per_facet_worth_a_grid = 7.0;

/// Where many sizes are sure to be asked for, smaller exact cells, which answer in two thirds of
/// the time, are worth building a third longer.
constexpr int facets_per_exact_leaf_for_many_sizes = 96;

/// Below so many sizes nobody notices who answers.
constexpr double fewest_sizes_worth_a_grid = 20000.0;

}  // namespace

void SizeField::build(const std::vector<Entity>& entities, double sizes_per_tetrahedron) {
  std::vector<bool> wanted(groups_.size(), entities.empty());
  for (const Entity& entity : entities) {
    const auto found = group_of_.find(entity);
    if (found != group_of_.end()) {
      wanted[found->second] = true;
    }
  }
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    Group& group = groups_[i];
    if (!wanted[i] ||
        (!group.changed && (group.grid || !wants_grid(group, entities, sizes_per_tetrahedron)))) {
      continue;
    }
    // Built aside and moved in at the end: if building fails, the group answers as before.
    Group built = group;
    if (built.changed) {
      build_tree(built);
    }
    if (!built.grid && wants_grid(built, entities, sizes_per_tetrahedron)) {
      build_grid(i, built);
    }
    group = std::move(built);
  }
}

void SizeField::build_grids() {
  build_trees();
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    Group& group = groups_[i];
    if (!group.grid && options_.evaluator != Evaluator::exact && !group.tree->empty()) {
      build_grid(i, group);
    }
  }
}

void SizeField::build_trees() {
  for (Group& group : groups_) {
    if (group.changed) {
      build_tree(group);
    }
  }
}

Box SizeField::box_of(const Group& group) const {
  Box box;
  for (const Entity& entity : group.entities) {
    box.extend(topology_->box(entity));
  }
  return box;
}

bool SizeField::wants_grid(const Group& group, const std::vector<Entity>& entities,
                           double sizes_per_tetrahedron) const {
  if (options_.evaluator == Evaluator::exact || group.tree->empty()) {
    return false;
  }
  if (options_.evaluator == Evaluator::grid) {
    return true;
  }
  Box box;
  for (const Entity& entity : entities.empty() ? group.entities : entities) {
    if (entity.dim == 3 && this->group(entity) != nullptr) {
      box.extend(topology_->box(entity));
    }
  }
  const StoredArray<SizedFacet>& facets = group.tree->facets();
  const double sizes =
      sizes_per_tetrahedron <= 0.0 || box.isEmpty()
          ? 0.0
          : sizes_per_tetrahedron * expected_tetrahedra(facets, group.size_limit, box);
  const int threads = options_.threads > 0 ? options_.threads : default_threads();
  return sizes * threads > sizes_per_facet_worth_a_grid * static_cast<double>(facets.size()) &&
         sizes > fewest_sizes_worth_a_grid;
}

void SizeField::build_tree(Group& group) const {
  const StopWatch watch;
  double size_limit = no_size;
  Action limiting;
  SizedFacets facets;
  std::vector<Origin> origins;
  for (const Action& action : group.actions) {
    if (!is_effective(action.function)) {
      continue;
    }
    const SizeFunction& function = functions_[action.function];
    double limit = function.size_limit;
    const bool has_one_size = action.inside_source && function.start_size <= limit;
    limit = has_one_size ? function.start_size : limit;
    if (limit < size_limit) {
      size_limit = limit;
      limiting = {action.function, has_one_size};
    }
    if (!action.inside_source && facets_[action.function]) {
      const SizedFacets& more = *facets_[action.function];
      origins.push_back({facets.size(), action.function, origins_[action.function]});
      facets.insert(facets.end(), more.begin(), more.end());
    }
  }
  const int threads = threads_for(facets.size());
  group.tree = std::make_shared<FacetTree>(std::move(facets), threads);
  group.origins = std::move(origins);  // from here on nothing throws
  group.limit = limiting;
  group.size_limit = size_limit;
  group.grid = nullptr;
  group.changed = false;
  group.tree_seconds = watch.seconds();
}

int SizeField::threads_for(std::size_t facets) const {
  // Threads cost more than they save on few facets, most of all where processors are busy.
  return facets < 2000 ? 1 : options_.threads;
}

/// Null where it is not known.
std::shared_ptr<const AttachedRegion> SizeField::region_of(const Group& group) const {
  std::vector<Entity> volumes;
  for (const Entity& entity : group.entities) {
    if (entity.dim == 3) {
      volumes.push_back(entity);
    }
  }
  if (!options_.boundary || volumes.empty()) {
    return nullptr;
  }
  const std::vector<std::array<Vec3, 3>> triangles = options_.boundary(volumes);
  if (triangles.empty()) {
    return nullptr;
  }
  return std::make_shared<AttachedRegion>(triangles, threads_for(triangles.size()));
}

void SizeField::build_grid(std::size_t index, Group& group) const {
  GridOptions grid_options;
  grid_options.tolerance = options_.tolerance;
  grid_options.threads = threads_for(group.tree->facets().size());
  if (options_.evaluator == Evaluator::automatic) {
    grid_options.facets_per_exact_leaf = facets_per_exact_leaf_for_many_sizes;
  }
  if (options_.progress) {
    const std::string what =
        "Background grid " + std::to_string(index + 1) + " of " + std::to_string(groups_.size()) +
        " (" + entity_names({group.entities.rbegin(), group.entities.rend()}, 2) + ")";
    grid_options.progress = [this, what](double done) { options_.progress(what, done); };
  }
  grid_options.region = region_of(group);
  grid_options.max_cells = options_.max_cells;
  group.grid =
      std::make_shared<BackgroundGrid>(group.tree, group.size_limit, box_of(group), grid_options);
  const BackgroundGrid::Statistics& grid = group.grid->statistics();
  if (grid.is_limited && options_.warn) {
    options_.warn("The background grid of " +
                  entity_names({group.entities.rbegin(), group.entities.rend()}, 2) +
                  " needs more than " + grouped_digits(grid.max_cells) +
                  " cells and is coarser than it should be: sizes keep the tolerance " +
                  shortest(options_.tolerance) +
                  ", but more of them are searched for in the facets, which takes longer; raise "
                  "max_cells or the tolerance.");
  }
}

// ==== Answers

const SizeField::Group* SizeField::group(const Entity& entity) const {
  const auto found = group_of_.find(entity);
  return found == group_of_.end() ? nullptr : &groups_[found->second];
}

std::vector<std::size_t> SizeField::functions_on(const Entity& entity) const {
  std::vector<std::size_t> result;
  if (const Group* found = group(entity)) {
    for (const Action& action : found->actions) {
      result.push_back(action.function);
    }
  }
  return result;
}

double SizeField::size(const Entity& entity, const Vec3& p) const {
  const Group* found = group(entity);
  if (found == nullptr || !found->tree || !p.allFinite()) {
    return no_size;
  }
  bool interpolated = false;
  const double size =
      found->grid ? found->grid->size(p, interpolated) : found->tree->size(p, found->size_limit);
  found->answers->add(interpolated ? AnswerCount::grid : AnswerCount::exact);
  return size;
}

double SizeField::exact_size(const Entity& entity, const Vec3& p) const {
  const Group* found = group(entity);
  if (found == nullptr || !found->tree || !p.allFinite()) {
    return no_size;
  }
  return found->tree->size(p, found->size_limit);
}

/// `ask(group, points, count, sizes)` for stretches of points that are finite; `no_size` for the
/// others, and where no function acts.
template <typename Ask>
void SizeField::ask_at_finite(const Entity& entity, const Vec3* points, std::size_t count,
                              double* sizes, Ask ask) const {
  std::fill(sizes, sizes + count, no_size);
  const Group* found = group(entity);
  if (found == nullptr || !found->tree) {
    return;
  }
  for (std::size_t begin = 0; begin < count;) {
    std::size_t end = begin;
    while (end < count && points[end].allFinite()) {
      ++end;
    }
    if (end > begin) {
      ask(*found, points + begin, end - begin, sizes + begin);
    }
    begin = end + 1;
  }
}

void SizeField::sizes(const Entity& entity, const Vec3* points, std::size_t count,
                      double* sizes) const {
  ask_at_finite(entity, points, count, sizes,
                [](const Group& group, const Vec3* from, std::size_t n, double* to) {
                  std::size_t interpolated = 0;
                  if (group.grid) {
                    interpolated = group.grid->sizes(from, n, to);
                  } else {
                    group.tree->sizes(from, n, group.size_limit, to);
                  }
                  group.answers->add(AnswerCount::grid, interpolated);
                  group.answers->add(AnswerCount::exact, n - interpolated);
                });
}

void SizeField::exact_sizes(const Entity& entity, const Vec3* points, std::size_t count,
                            double* sizes) const {
  ask_at_finite(entity, points, count, sizes,
                [](const Group& group, const Vec3* from, std::size_t n, double* to) {
                  group.tree->sizes(from, n, group.size_limit, to);
                });
}

// ==== Parts

SizeField::Parts SizeField::parts() const {
  Parts parts = {options_.tolerance, *topology_, functions_, effective_, facet_counts_, {}};
  for (const Group& group : groups_) {
    if (group.changed || !group.tree) {
      throw Error("The size field has changed since it was built: build it before saving it.");
    }
    parts.groups.push_back({group.actions, group.entities, group.size_limit, group.limit,
                            group.origins, group.tree, group.grid});
  }
  return parts;
}

SizeField::SizeField(Parts parts)
    : topology_(std::make_shared<Topology>(std::move(parts.topology))),
      functions_(std::move(parts.functions)),
      facets_(functions_.size()),
      facet_counts_(std::move(parts.facet_counts)),
      origins_(functions_.size()),
      effective_(std::move(parts.effective)) {
  options_.tolerance = parts.tolerance;
  for (Part& part : parts.groups) {
    for (const Entity& entity : part.entities) {
      group_of_[entity] = groups_.size();
    }
    Group group;
    group.actions = std::move(part.actions);
    group.entities = std::move(part.entities);
    group.changed = false;
    group.size_limit = part.size_limit;
    group.limit = part.limit;
    group.origins = std::move(part.origins);
    group.tree = std::move(part.tree);
    group.grid = std::move(part.grid);
    groups_.push_back(std::move(group));
  }
}

// ==== Summary

std::vector<SizeField::GroupSummary> SizeField::groups() const {
  std::vector<GroupSummary> result;
  for (const Group& group : groups_) {
    GroupSummary summary;
    summary.entities = group.entities;
    for (const Action& action : group.actions) {
      summary.functions.push_back(action.function);
    }
    summary.size_limit = group.size_limit;
    if (group.tree) {
      summary.facets = group.tree->facets().size();
      summary.tree_bytes = group.tree->memory_bytes();
      summary.tree_seconds = group.tree_seconds;
      summary.exact_answers = group.answers->total(AnswerCount::exact);
      summary.answers = summary.exact_answers + group.answers->total(AnswerCount::grid);
    }
    if (group.grid) {
      summary.has_grid = true;
      summary.grid = group.grid->statistics();
    }
    result.push_back(std::move(summary));
  }
  return result;
}

}  // namespace meshgrow
