#include "ordered_mesher.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "error.h"
#include "gmsh_api.h"
#include "mapped_surface.h"
#include "meshing_plan.h"
#include "periodic_copies.h"
#include "remesh.h"
#include "restore.h"
#include "stop_watch.h"

namespace meshgrow {

namespace {

/// Times that the run is started again because Gmsh has split curves.
constexpr int most_splits = 4;

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

/// Periodic entities and their masters. Mapped surfaces are not among them: Gmsh meshes those from
/// their curves, whatever they are copies of.
std::map<Entity, Entity> copied_by_us(const Topology& topology,
                                      const MeshConstraints& constraints) {
  std::map<Entity, Entity> masters = periodic_masters(topology);
  for (const MappedSurface& mapped : constraints.mapped_surfaces) {
    masters.erase(mapped.surface);
  }
  return masters;
}

/// Adds the curves around meshed surfaces that files leave without elements, where only surfaces
/// are physical groups. They have no geometry to be meshed by, and the surfaces bring their nodes.
std::set<Entity> with_bare_curves(std::set<Entity> meshed, const Topology& topology) {
  for (const Entity& surface : topology.entities(2)) {
    for (const Entity& curve : topology.lower(surface)) {
      if (curve.dim == 1 && meshed.count(surface) > 0 && meshed.count(curve) == 0 &&
          gmsh::is_discrete(curve)) {
        meshed.insert(curve);
      }
    }
  }
  return meshed;
}

MeshingTask task_of(const SizeField& field, std::set<Entity> meshed, const CurveAdjuster& adjuster,
                    const std::map<Entity, Entity>& masters, std::set<Entity> companions) {
  meshed = with_bare_curves(std::move(meshed), field.topology());
  for (const auto& [copy, master] : masters) {
    if (meshed.count(copy) > 0 && meshed.count(master) == 0) {
      throw Error(entity_name(copy) + " has a mesh, but it is a periodic copy of " +
                  entity_name(master) + ", which has none: mesh both beforehand, or neither.");
    }
  }
  return {field.topology(), field.functions(),    std::move(meshed), adjuster.connected_curves(),
          masters,          std::move(companions)};
}

}  // namespace

OrderedMesher::OrderedMesher(ModelField& model_field)
    : model_field_(model_field),
      field_(model_field.field()),
      all_(field_.topology().entities()),
      premeshed_(field_.topology()),
      constraints_(read_mesh_constraints(field_.topology())),
      structured_faces_(structured_faces(field_.topology(), constraints_)),
      adjuster_(field_.topology(), constraints_),
      masters_(copied_by_us(field_.topology(), constraints_)) {}

void OrderedMesher::check_options() {
  if (gmsh::option("Mesh.SubdivisionAlgorithm") != 0.0) {
    throw Error(
        "Mesh.SubdivisionAlgorithm would split the premeshed elements too: set it to 0 and "
        "call refine() after meshing.");
  }
}

void OrderedMesher::check_premeshed(const std::vector<MeshingPass>& passes) const {
  const std::optional<Entity> curved = premeshed_.any_of_higher_order();
  if (curved && gmsh::option("Mesh.ElementOrder") < 2.0) {
    gmsh::log(entity_name(*curved) +
                  " keeps its elements of higher order, but what is meshed beside it will be of "
                  "first order: set Mesh.ElementOrder to 2 for a conforming mesh.",
              "warning");
  }
  const Topology& topology = field_.topology();
  const bool curves_are_meshed = std::any_of(passes.begin(), passes.end(),
                                             [](const MeshingPass& pass) { return pass.dim == 1; });
  for (const Entity& surface : topology.entities(2)) {
    if (!premeshed_.contains(surface)) {
      continue;
    }
    for (const Entity& curve : topology.lower(surface)) {
      if (curve.dim == 1 && !premeshed_.contains(curve) && !gmsh::is_discrete(curve) &&
          !has_no_length(curve, topology)) {
        throw Error(entity_name(surface) + " has a mesh, but " + entity_name(curve) +
                    " on its boundary has none: mesh both beforehand, or neither.");
      }
    }
    if (curves_are_meshed && structured_faces_.count(surface) > 0) {
      for (const Entity& volume : constraints_.mapped_volumes) {
        if (!premeshed_.contains(volume) && topology.closure({volume}).count(surface) > 0) {
          throw Error(entity_name(volume) + " is mapped (transfinite) and its " +
                      entity_name(surface) +
                      " has a mesh, whose structure Gmsh forgets when it meshes curves: mesh all "
                      "curves beforehand as well, or leave the surface unmeshed.");
        }
      }
    }
  }
}

std::vector<MeshingPass> OrderedMesher::plan(const SizeField& field, std::set<Entity> meshed,
                                             int dim) {
  const MeshConstraints constraints = read_mesh_constraints(field.topology());
  const CurveAdjuster adjuster(field.topology(), constraints);
  return plan_meshing(
      task_of(field, std::move(meshed), adjuster, copied_by_us(field.topology(), constraints), {}),
      dim);
}

std::vector<MeshingPass> OrderedMesher::plan(int dim) const {
  return plan_meshing(task_of(field_, premeshed_.entities(), adjuster_, masters_, companions_),
                      dim);
}

void OrderedMesher::generate(int dim) {
  std::vector<MeshingPass> passes = plan(dim);
  check_premeshed(passes);
  state_.set_option("Mesh.MeshOnlyVisible", 1.0);
  state_.set_option("Mesh.MeshOnlyEmpty", 0.0);
  state_.set_option("Mesh.Renumber", 0.0);
  state_.set_option("Mesh.ElementOrder", 1.0);
  user_premeshed_ = premeshed_.entities();
  const SizeCallback callback(model_field_.answers_, model_field_.model());
  try {
    while (true) {
      try {
        run(passes);
        break;
      } catch (const LeftEmpty& left) {
        start_with_companions(left);
      } catch (const SplitCurves& split) {
        start_with_split_curves(split);
      }
      passes = plan(dim);
    }
    model_field_.answers_.set_boundary(nullptr);
    premeshed_.put_back_changed();
    read_new_sources();
  } catch (...) {
    model_field_.answers_.clear_scales();
    model_field_.answers_.set_boundary(nullptr);
    restore([this] { premeshed_.put_back_missing(); });
    restore([this] { premeshed_.put_back_after_error(); });
    restore([this] { clear_unadjusted_curves(); });
    throw;
  }
}

void OrderedMesher::start_with_companions(const LeftEmpty& left) {
  // Gmsh makes extruded layers and other copies only in the pass that meshes what they come from,
  // and tells nobody what that is. So these go along with every pass from the first possible on.
  bool any_new = false;
  for (const Entity& entity : left.entities) {
    any_new = companions_.insert(entity).second || any_new;
  }
  if (!any_new) {
    refuse_empty(left);
  }
  model_field_.tell("Starting again: Gmsh left " + entity_names(left.entities) +
                    " without a mesh, as it does with what it meshes only along with something "
                    "that it is extruded or copied from");
  clear_meshed();
}

void OrderedMesher::start_with_split_curves(const SplitCurves& split) {
  model_field_.tell("Starting again: Gmsh has split elements of " + entity_names(split.curves) +
                    ", which intersect, and other surfaces stand on them");
  ++split_count_;
  premeshed_.keep(split.curves);
  split_curves_.insert(split.curves.begin(), split.curves.end());
  clear_meshed();
}

void OrderedMesher::clear_meshed() {
  std::set<Entity> kept = user_premeshed_;
  kept.insert(split_curves_.begin(), split_curves_.end());
  clear_all_but(kept, field_);
  premeshed_.keep_only(kept);
  waiting_.clear();
  lost_faces_.clear();
  unadjusted_.clear();
}

void OrderedMesher::run(const std::vector<MeshingPass>& plan) {
  planned_count_ = plan.size();
  pass_count_ = 0;
  for (std::size_t i = 0; i < field_.functions().size(); ++i) {
    stale_.insert(i);
  }
  model_field_.reported_.clear();
  for (auto pass = plan.begin(); pass != plan.end(); ++pass) {
    const auto next = pass + 1;
    const bool curves_follow =
        std::any_of(next, plan.end(), [](const MeshingPass& later) { return later.dim == 1; });
    if (pass->dim == 1) {
      std::copy_if(pass->entities.begin(), pass->entities.end(), std::back_inserter(unadjusted_),
                   [this](const Entity& curve) { return masters_.count(curve) == 0; });
    }
    run_pass(*pass, curves_follow);
    if (!unadjusted_.empty() && (next == plan.end() || next->stage != pass->stage)) {
      adjust_curves(unadjusted_);
      // Gmsh reverses curves that the user wants reversed again in every pass.
      premeshed_.keep(unadjusted_);
      unadjusted_.clear();
    }
    if (!curves_follow) {
      mesh_lost_faces();
    }
  }
  LeftEmpty left{{}, "any pass"};
  std::copy_if(waiting_.begin(), waiting_.end(), std::back_inserter(left.entities),
               [](const Entity& entity) { return entity.dim == 2; });
  if (!left.entities.empty()) {
    refuse_empty(left);
  }
}

void OrderedMesher::run_pass(const MeshingPass& pass, bool curves_follow) {
  read_new_sources();
  const std::vector<Entity> open = without_copies(pass.entities);
  report_unmeshed_sources(open);
  // A source may turn out to have no elements, and then its function does not act after all.
  std::vector<Entity> attached;
  std::vector<Entity> others;
  std::partition_copy(open.begin(), open.end(), std::back_inserter(attached),
                      std::back_inserter(others),
                      [&](const Entity& e) { return pass.attached && acts_effectively(e); });
  ++pass_count_;
  for (const bool is_attached : {true, false}) {
    std::vector<Entity> entities = is_attached ? attached : others;
    if (entities.empty()) {
      continue;
    }
    if (is_attached) {
      field_.build(entities, pass.dim == 3 ? ModelField::sizes_per_tetrahedron() : 0.0);
    }
    const std::string name = "pass " + std::to_string(pass_count_) + " of " +
                             std::to_string(planned_count_) + " (" + entity_names(entities, 3) +
                             (is_attached ? "; sizes from the field)" : "; Gmsh's own sizes)");
    model_field_.tell("Meshing, " + name);
    std::copy_if(waiting_.begin(), waiting_.end(), std::back_inserter(entities),
                 [&pass](const Entity& entity) { return entity.dim == pass.dim; });
    mesh(entities, is_attached, name);
    const std::vector<Entity> meshed = take_meshed(entities, name);
    if (pass.dim == 2) {
      keep_split_curves(entities);
    }
    if (pass.dim == 2 && curves_follow) {
      keep_from_curve_passes(meshed);
    }
    mark_stale(meshed);
  }
}

std::vector<Entity> OrderedMesher::without_copies(const std::vector<Entity>& entities) {
  std::vector<Entity> others;
  std::vector<Entity> copies;
  for (const Entity& entity : entities) {
    const auto master = masters_.find(entity);
    if (master == masters_.end() || !gmsh::has_elements(master->second)) {
      others.push_back(entity);
      continue;
    }
    copy_from_master(entity, master->second, field_.topology());
    copies.push_back(entity);
  }
  if (!copies.empty()) {
    model_field_.tell("Copied the meshes of their masters to " + entity_names(copies));
    premeshed_.keep(copies);
    mark_stale(copies);
  }
  return others;
}

std::vector<Entity> OrderedMesher::take_meshed(const std::vector<Entity>& entities,
                                               const std::string& pass_name) {
  LeftEmpty left;
  std::vector<Entity> meshed;
  for (const Entity& entity : entities) {
    if (gmsh::has_elements(entity)) {
      meshed.push_back(entity);
      waiting_.erase(entity);
    } else if (companions_.count(entity) > 0) {
      waiting_.insert(entity);
    } else if (entity.dim > 1 || !has_no_length(entity, field_.topology())) {
      left.entities.push_back(entity);
    }
  }
  if (!left.entities.empty()) {
    left.pass_name = pass_name;
    const bool may_be_copies = entities.front().dim < 3 && gmsh::last_error().empty() &&
                               std::none_of(left.entities.begin(), left.entities.end(),
                                            [](const Entity& e) { return gmsh::is_discrete(e); });
    if (!may_be_copies) {
      refuse_empty(left);
    }
    throw left;
  }
  return meshed;
}

void OrderedMesher::keep_split_curves(const std::vector<Entity>& surfaces) {
  // Where curves intersect each other in the plane of a surface, Gmsh splits their elements. Curves
  // of this run may be split as long as nothing else stands on them.
  const std::set<Entity> now(surfaces.begin(), surfaces.end());
  std::set<Entity> below;
  for (const Entity& entity : field_.topology().closure(surfaces)) {
    if (entity.dim == 1 && user_premeshed_.count(entity) == 0) {
      below.insert(entity);
    }
  }
  for (const Entity& surface : field_.topology().entities(2)) {
    if (now.count(surface) == 0 && gmsh::has_elements(surface)) {
      for (const Entity& curve : field_.topology().lower(surface)) {
        below.erase(curve);
      }
    }
  }
  const std::vector<Entity> kept = premeshed_.keep_of_other_cells({below.begin(), below.end()});
  mark_stale(kept);
  check_split_curves(surfaces, kept);
}

void OrderedMesher::check_split_curves(const std::vector<Entity>& surfaces,
                                       const std::vector<Entity>& kept) {
  const std::set<Entity> below = field_.topology().closure(surfaces);
  SplitCurves split{premeshed_.misfits({below.begin(), below.end()})};
  if (split.curves.empty()) {
    return;
  }
  const bool may_change =
      std::all_of(split.curves.begin(), split.curves.end(), [this](const Entity& entity) {
        return entity.dim == 1 && user_premeshed_.count(entity) == 0 && masters_.count(entity) == 0;
      });
  if (!may_change || split_count_ == most_splits) {
    // At once: volumes cannot be meshed from surfaces that end beside each other.
    premeshed_.put_back_changed();
  }
  split.curves.insert(split.curves.end(), kept.begin(), kept.end());
  throw split;
}

void OrderedMesher::keep_from_curve_passes(const std::vector<Entity>& surfaces) {
  premeshed_.keep(surfaces);
  std::copy_if(surfaces.begin(), surfaces.end(), std::back_inserter(lost_faces_),
               [this](const Entity& surface) { return structured_faces_.count(surface) > 0; });
}

void OrderedMesher::mesh_lost_faces() {
  if (!lost_faces_.empty()) {
    // With its mesh Gmsh has forgotten the structure that a mapped volume needs. The curves
    // determine the mesh, so that the same one comes out again.
    std::set<Entity> others = premeshed_.entities();
    for (const Entity& face : lost_faces_) {
      others.erase(face);
    }
    premeshed_.keep_only(others);
    mesh(lost_faces_, true, "the structure of " + entity_names(lost_faces_, 3));
    lost_faces_.clear();
  }
}

void OrderedMesher::protect_discrete_faces(const std::vector<Entity>& volumes) const {
  for (const Entity& entity : field_.topology().closure(volumes)) {
    if (entity.dim == 2 && gmsh::has_elements(entity) && gmsh::is_discrete(entity)) {
      // Gmsh counts no discrete surfaces when it asks whether surfaces are meshed, and then meshes
      // those with a parametrisation again. A single element, which it removes, says that
      // the model is meshed up to volumes.
      if (!gmsh::has_elements(volumes.front())) {
        const std::size_t node = gmsh::elements(entity).front().node_tags.front();
        gmsh::add_elements(volumes.front(),
                           {{gmsh::tetrahedron_type, {}, {node, node, node, node}}});
      }
      return;
    }
  }
}

void OrderedMesher::remove_protection(const Entity& volume) const {
  const std::vector<gmsh::Elements> elements = gmsh::elements(volume);
  if (volume.dim == 3 && elements.size() == 1 && elements.front().node_tags.size() == 4 &&
      elements.front().node_tags[0] == elements.front().node_tags[1]) {
    gmsh::clear_mesh({volume});
  }
}

void OrderedMesher::mesh(const std::vector<Entity>& entities, bool attached,
                         const std::string& name) {
  model_field_.stop_if_asked();
  constexpr const char* extend = "Mesh.MeshSizeExtendFromBoundary";
  state_.set_option(extend, attached ? 0.0 : state_.user_option(extend));
  // With what Gmsh has made for compounds meanwhile.
  state_.show_only(entities, gmsh::entities());
  if (entities.front().dim == 3) {
    protect_discrete_faces(entities);
    if (gmsh::option("Mesh.Algorithm3D") == 10.0 && gmsh::is_4_8()) {
      // On several threads HXT of 4.8 leaves holes now and then.
      state_.set_option("Mesh.MaxNumThreads3D", 1.0);
    }
    const bool by_distance = attached && model_field_.answers_.is_calibrated();
    model_field_.answers_.set_boundary(
        by_distance ? std::make_unique<const BoundaryDistance>(entities, field_.topology())
                    : nullptr);
  }
  const StopWatch watch;
  try {
    gmsh::generate(entities.front().dim);
    model_field_.run_times_.gmsh += watch.seconds();
  } catch (const Error& error) {
    remove_protection(entities.front());
    check_faces_stayed(entities, name);
    throw Error("Meshing stopped in " + name + ": " + error.what());
  }
  remove_protection(entities.front());
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

void OrderedMesher::clear_unadjusted_curves() const {
  for (const std::vector<Entity>& connected : adjuster_.connected_curves()) {
    for (const Entity& curve : connected) {
      if (std::count(unadjusted_.begin(), unadjusted_.end(), curve) > 0 &&
          gmsh::has_elements(curve)) {
        gmsh::clear_mesh({curve});
      }
    }
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

void OrderedMesher::refuse_empty(const LeftEmpty& left) const {
  const auto discrete = std::find_if(
      left.entities.begin(), left.entities.end(),
      [](const Entity& entity) { return entity.dim == 3 && gmsh::is_discrete(entity); });
  if (discrete != left.entities.end()) {
    throw Error(entity_name(*discrete) +
                " came with a mesh and has no geometry, and Gmsh meshes no such volume again: open "
                "the geometry before the mesh, or put a volume on the surfaces in a model without "
                "it.");
  }
  const auto scanned = std::find_if(
      left.entities.begin(), left.entities.end(),
      [](const Entity& entity) { return entity.dim < 3 && gmsh::is_discrete(entity); });
  const std::string reason = gmsh::last_error();
  if (scanned != left.entities.end() && reason.empty()) {
    throw Error(entity_name(*scanned) +
                " came with a mesh and has no geometry, and Gmsh did not mesh it again: keep its "
                "mesh, or call classifySurfaces() and createGeometry() before it is taken away.");
  }
  throw Error("Gmsh could not mesh " + entity_names(left.entities) + " in " + left.pass_name +
              (reason.empty() ? "" : " (" + reason + ")") +
              ": repair the geometry, change sizes or algorithm, or, if it is extruded from "
              "something meshed before, mesh it beforehand as well; the rest is kept.");
}

}  // namespace meshgrow
