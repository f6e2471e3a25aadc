// How a SizeField builds the trees and grids of its groups.

#include "expected_elements.h"
#include "number_text.h"
#include "parallel.h"
#include "size_field.h"
#include "stop_watch.h"

namespace meshgrow {

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

}  // namespace meshgrow
