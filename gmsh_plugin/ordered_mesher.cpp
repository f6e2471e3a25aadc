#include "ordered_mesher.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "error.h"
#include "gmsh_api.h"
#include "volume_nesting.h"

namespace meshgrow {

OrderedMesher::OrderedMesher(ModelField& model_field)
    : model_field_(model_field),
      field_(model_field.field()),
      all_(field_.topology().entities()),
      premeshed_(field_.topology()) {}

void OrderedMesher::check_options() const {
  if (gmsh::option("Mesh.SubdivisionAlgorithm") != 0.0) {
    throw Error(
        "Mesh.SubdivisionAlgorithm would split the premeshed elements too: set it to 0 and "
        "call refine() after meshing.");
  }
  const std::optional<Entity> curved = premeshed_.any_of_higher_order();
  if (curved && gmsh::option("Mesh.ElementOrder") < 2.0) {
    gmsh::log(entity_name(*curved) +
                  " keeps its elements of higher order, but what is meshed beside it will be of "
                  "first order: set Mesh.ElementOrder to 2 for a conforming mesh.",
              "warning");
  }
}

void OrderedMesher::generate(int dim) {
  if (dim < 1 || dim > 3) {
    throw Error("Cannot mesh dimension " + std::to_string(dim) + ": give 1, 2 or 3.");
  }
  check_options();
  state_.set_option("Mesh.MeshOnlyVisible", 1.0);
  state_.set_option("Mesh.MeshOnlyEmpty", 0.0);
  state_.set_option("Mesh.Renumber", 0.0);
  state_.set_option("Mesh.ElementOrder", 1.0);

  std::vector<Entity> sources;
  for (std::size_t i = 0; i < field_.functions().size(); ++i) {
    const SizeFunction& function = field_.functions()[i];
    stale_.insert(i);
    if (function.kind == Kind::mesh) {
      sources.insert(sources.end(), function.sources.begin(), function.sources.end());
    }
  }
  model_field_.reported_.clear();
  {
    const SizeCallback callback(field_, model_field_.model());
    try {
      curves_follow_ = true;
      mesh(field_.topology().closure(sources), dim);
      curves_follow_ = false;
      mesh({all_.begin(), all_.end()}, dim);
      premeshed_.put_back_changed();
      read_new_sources();
    } catch (...) {
      premeshed_.put_back_missing();
      premeshed_.put_back_changed();
      throw;
    }
  }
}

bool OrderedMesher::acts_effectively(const Entity& entity) const {
  const std::vector<std::size_t> functions = field_.functions_on(entity);
  return std::any_of(functions.begin(), functions.end(),
                     [this](std::size_t function) { return field_.is_effective(function); });
}

void OrderedMesher::mesh(const std::set<Entity>& entities, int dim) {
  for (int pass_dim = 1; pass_dim <= dim; ++pass_dim) {
    std::vector<Entity> open;
    for (const Entity& entity : entities) {
      if (entity.dim == pass_dim && !premeshed_.contains(entity) && done_.count(entity) == 0) {
        open.push_back(entity);
      }
    }
    if (open.empty()) {
      continue;
    }
    read_new_sources();
    std::vector<Entity> attached;
    std::vector<Entity> others;
    std::partition_copy(open.begin(), open.end(), std::back_inserter(attached),
                        std::back_inserter(others),
                        [this](const Entity& e) { return acts_effectively(e); });
    if (pass_dim < 3) {
      pass(attached, true);
      pass(others, false);
      continue;
    }
    const std::set<Entity> attached_set(attached.begin(), attached.end());
    for (const auto& volumes : volume_passes(open, attached_set, field_.topology())) {
      pass(volumes, attached_set.count(volumes.front()) > 0);
    }
  }
}

void OrderedMesher::read_new_sources() {
  model_field_.read_sources({stale_.begin(), stale_.end()});
  stale_.clear();
}

void OrderedMesher::report_unmeshed_sources(const std::vector<Entity>& entities) {
  std::map<std::size_t, std::vector<Entity>> acted_on;
  for (const Entity& entity : entities) {
    for (const std::size_t function : field_.functions_on(entity)) {
      acted_on[function].push_back(entity);
    }
  }
  for (const auto& [function, targets] : acted_on) {
    // A source's own boundary is meshed before it, and other sources of the function are not asked
    // to wait for it.
    const std::set<Entity> own = field_.topology().closure(field_.functions()[function].sources);
    if (std::any_of(targets.begin(), targets.end(),
                    [&own](const Entity& entity) { return own.count(entity) == 0; })) {
      model_field_.report_unmeshed(function);
    }
  }
}

void OrderedMesher::pass(const std::vector<Entity>& entities, bool attached) {
  if (entities.empty()) {
    return;
  }
  report_unmeshed_sources(entities);
  if (attached) {
    field_.build(entities);
  }
  const int dim = entities.front().dim;
  const std::string name = "pass " + std::to_string(++pass_count_) + " (" +
                           entity_names(entities, 3) +
                           (attached ? "; sizes from the field)" : "; Gmsh's own sizes)");
  model_field_.tell("Meshing, " + name);
  constexpr const char* extend = "Mesh.MeshSizeExtendFromBoundary";
  state_.set_option(extend, attached ? 0.0 : state_.user_option(extend));
  state_.show_only(entities, all_);
  try {
    gmsh::generate(dim);
  } catch (const Error& error) {
    check_faces_stayed(entities, name);
    throw Error("Meshing stopped in " + name + ": " + error.what());
  }
  check_faces_stayed(entities, name);
  premeshed_.put_back_missing();
  check_result(entities, name);
  done_.insert(entities.begin(), entities.end());
  if (dim == 2 && curves_follow_) {
    premeshed_.keep(entities);
  }
  for (std::size_t i = 0; i < field_.functions().size(); ++i) {
    const SizeFunction& function = field_.functions()[i];
    const auto just_meshed = [&entities](const Entity& source) {
      return std::count(entities.begin(), entities.end(), source) > 0;
    };
    if (function.kind == Kind::mesh &&
        std::any_of(function.sources.begin(), function.sources.end(), just_meshed)) {
      stale_.insert(i);
    }
  }
}

void OrderedMesher::check_faces_stayed(const std::vector<Entity>& entities,
                                       const std::string& pass_name) const {
  if (entities.front().dim < 3) {
    return;  // a pass over curves takes surface meshes away rightly: they are put back after it
  }
  std::vector<Entity> gone;
  for (const Entity& entity : field_.topology().closure(entities)) {
    if (entity.dim == 2 && premeshed_.contains(entity) && !gmsh::has_elements(entity)) {
      gone.push_back(entity);
    }
  }
  if (!gone.empty()) {
    throw Error("Gmsh threw away the mesh of " + entity_names(gone) + " in " + pass_name +
                ", as it does with discrete surfaces that have a parametrisation: leave out "
                "createGeometry(), or use register() and Gmsh's own generate(); the mesh was put "
                "back.");
  }
}

void OrderedMesher::check_result(const std::vector<Entity>& entities,
                                 const std::string& pass_name) const {
  std::vector<Entity> empty;
  for (const Entity& entity : entities) {
    // Curves of zero length (poles, tips) stay without elements rightly.
    if (entity.dim > 1 && !gmsh::has_elements(entity)) {
      empty.push_back(entity);
    }
  }
  if (!empty.empty()) {
    const std::string reason = gmsh::last_error();
    throw Error("Gmsh could not mesh " + entity_names(empty) + " in " + pass_name +
                (reason.empty() ? "" : " (" + reason + ")") +
                ": repair the geometry or change sizes or algorithm; the rest is kept.");
  }
}

}  // namespace meshgrow
