#include "ordered_mesher.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "error.h"
#include "gmsh_api.h"
#include "meshing_plan.h"

namespace meshgrow {

namespace {

std::set<Entity> structured_faces(const Topology& topology, const MeshConstraints& constraints) {
  const std::set<Entity> below = topology.closure(constraints.mapped_volumes);
  std::set<Entity> result;
  for (const MappedSurface& mapped : constraints.mapped_surfaces) {
    if (below.count(mapped.surface) > 0) {
      result.insert(mapped.surface);
    }
  }
  return result;
}

}  // namespace

OrderedMesher::OrderedMesher(ModelField& model_field)
    : model_field_(model_field),
      field_(model_field.field()),
      all_(field_.topology().entities()),
      premeshed_(field_.topology()),
      constraints_(read_mesh_constraints(field_.topology())),
      structured_faces_(structured_faces(field_.topology(), constraints_)),
      adjuster_(field_.topology(), constraints_) {}

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

std::vector<MeshingPass> OrderedMesher::plan(const SizeField& field, int dim) {
  std::set<Entity> meshed;
  for (const Entity& entity : field.topology().entities()) {
    if (gmsh::has_elements(entity)) {
      meshed.insert(entity);
    }
  }
  const MeshConstraints constraints = read_mesh_constraints(field.topology());
  const CurveAdjuster adjuster(field.topology(), constraints);
  return plan_meshing({field.topology(), field.functions(), meshed, adjuster.connected_curves()},
                      dim);
}

void OrderedMesher::clear_all_but_sources(const SizeField& field) {
  const std::vector<Entity> all = field.topology().entities();
  std::vector<Entity> sources;
  for (const SizeFunction& function : field.functions()) {
    if (function.kind == Kind::mesh) {
      sources.insert(sources.end(), function.sources.begin(), function.sources.end());
    }
  }
  for (const Entity& entity : all) {
    // Without its mesh a discrete entity would be nothing.
    if (gmsh::entity_type(entity).find("Discrete") != std::string::npos) {
      sources.push_back(entity);
    }
  }
  const std::set<Entity> kept = field.topology().closure(sources);
  for (auto entity = all.rbegin(); entity != all.rend(); ++entity) {
    if (entity->dim > 0 && kept.count(*entity) == 0 && gmsh::has_elements(*entity)) {
      gmsh::clear_mesh({*entity});
    }
  }
}

void OrderedMesher::generate(int dim) {
  check_options();
  const std::vector<MeshingPass> plan = plan_meshing(
      {field_.topology(), field_.functions(), premeshed_.entities(), adjuster_.connected_curves()},
      dim);
  state_.set_option("Mesh.MeshOnlyVisible", 1.0);
  state_.set_option("Mesh.MeshOnlyEmpty", 0.0);
  state_.set_option("Mesh.Renumber", 0.0);
  state_.set_option("Mesh.ElementOrder", 1.0);
  for (std::size_t i = 0; i < field_.functions().size(); ++i) {
    stale_.insert(i);
  }
  model_field_.reported_.clear();
  const SizeCallback callback(model_field_.answers_, model_field_.model());
  try {
    run(plan);
    premeshed_.put_back_changed();
    read_new_sources();
  } catch (...) {
    model_field_.answers_.clear_scales();
    premeshed_.put_back_missing();
    premeshed_.put_back_changed();
    throw;
  }
}

void OrderedMesher::run(const std::vector<MeshingPass>& plan) {
  planned_count_ = plan.size();
  std::vector<Entity> stage;
  for (auto pass = plan.begin(); pass != plan.end(); ++pass) {
    const auto next = pass + 1;
    const bool curves_follow =
        std::any_of(next, plan.end(), [](const MeshingPass& later) { return later.dim == 1; });
    run_pass(*pass, curves_follow);
    if (pass->dim == 1) {
      stage.insert(stage.end(), pass->entities.begin(), pass->entities.end());
    }
    if (!stage.empty() && (next == plan.end() || next->stage != pass->stage)) {
      adjust_curves(stage);
      stage.clear();
    }
    if (!curves_follow) {
      mesh_lost_faces();
    }
  }
}

void OrderedMesher::run_pass(const MeshingPass& pass, bool curves_follow) {
  read_new_sources();
  report_unmeshed_sources(pass.entities);
  // A source may turn out to have no elements, and then its function does not act after all.
  std::vector<Entity> attached;
  std::vector<Entity> others;
  std::partition_copy(pass.entities.begin(), pass.entities.end(), std::back_inserter(attached),
                      std::back_inserter(others),
                      [&](const Entity& e) { return pass.attached && acts_effectively(e); });
  ++pass_count_;
  for (const bool is_attached : {true, false}) {
    const std::vector<Entity>& entities = is_attached ? attached : others;
    if (entities.empty()) {
      continue;
    }
    if (is_attached) {
      field_.build(entities);
    }
    const std::string name = "pass " + std::to_string(pass_count_) + " of " +
                             std::to_string(planned_count_) + " (" + entity_names(entities, 3) +
                             (is_attached ? "; sizes from the field)" : "; Gmsh's own sizes)");
    model_field_.tell("Meshing, " + name);
    mesh(entities, is_attached, name);
    check_result(entities, name);
    if (pass.dim == 2 && curves_follow) {
      keep_from_curve_passes(entities);
    }
    mark_stale(entities);
  }
}

void OrderedMesher::keep_from_curve_passes(const std::vector<Entity>& surfaces) {
  for (const Entity& surface : surfaces) {
    // With its mesh Gmsh forgets the structure that a mapped volume needs. The curves determine the
    // mesh, so that the same one comes out again.
    if (structured_faces_.count(surface) > 0) {
      lost_faces_.push_back(surface);
    } else {
      premeshed_.keep({surface});
    }
  }
}

void OrderedMesher::mesh_lost_faces() {
  if (!lost_faces_.empty()) {
    mesh(lost_faces_, true, "the structure of " + entity_names(lost_faces_, 3));
    lost_faces_.clear();
  }
}

void OrderedMesher::mesh(const std::vector<Entity>& entities, bool attached,
                         const std::string& name) {
  constexpr const char* extend = "Mesh.MeshSizeExtendFromBoundary";
  state_.set_option(extend, attached ? 0.0 : state_.user_option(extend));
  state_.show_only(entities, all_);
  try {
    gmsh::generate(entities.front().dim);
  } catch (const Error& error) {
    check_faces_stayed(entities, name);
    throw Error("Meshing stopped in " + name + ": " + error.what());
  }
  check_faces_stayed(entities, name);
  premeshed_.put_back_missing();
}

void OrderedMesher::adjust_curves(const std::vector<Entity>& stage) {
  constexpr const char* range[] = {"Mesh.MeshSizeMin", "Mesh.MeshSizeMax", "Mesh.MeshSizeFactor"};
  // Gmsh lets no size exceed its own and the model's: in a large unit, ours are far below them.
  constexpr double unit = 1e6;
  const auto mesh_again = [&](const std::vector<Entity>& curves,
                              std::map<Entity, SizeAnswers::Scale> scales) {
    model_field_.answers_.set_scales(
        std::move(scales),
        {state_.user_option(range[0]), state_.user_option(range[1]), state_.user_option(range[2])},
        unit);
    state_.set_option(range[0], 0.0);
    state_.set_option(range[1], 1e22);
    state_.set_option(range[2], unit);
    mesh(curves, true, "adjusting " + entity_names(curves, 3));
    for (const char* name : range) {
      state_.set_option(name, state_.user_option(name));
    }
    model_field_.answers_.clear_scales();
  };
  const std::vector<Entity> adjusted = adjuster_.adjust(stage, mesh_again);
  if (!adjusted.empty()) {
    model_field_.tell("Adjusted " + entity_names(adjusted, 6) + " for mapped surfaces");
    mark_stale(adjusted);
  }
}

bool OrderedMesher::acts_effectively(const Entity& entity) const {
  const std::vector<std::size_t> functions = field_.functions_on(entity);
  return std::any_of(functions.begin(), functions.end(),
                     [this](std::size_t function) { return field_.is_effective(function); });
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

void OrderedMesher::mark_stale(const std::vector<Entity>& meshed) {
  for (std::size_t i = 0; i < field_.functions().size(); ++i) {
    const SizeFunction& function = field_.functions()[i];
    if (function.kind == Kind::mesh &&
        std::any_of(function.sources.begin(), function.sources.end(), [&](const Entity& source) {
          return std::count(meshed.begin(), meshed.end(), source) > 0;
        })) {
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
