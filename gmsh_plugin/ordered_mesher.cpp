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

bool OrderedMesher::acts_effectively(const Entity& entity) const {
  const std::vector<std::size_t> functions = field_.functions_on(entity);
  return std::any_of(functions.begin(), functions.end(),
                     [this](std::size_t function) { return field_.is_effective(function); });
}

void OrderedMesher::read_new_sources() {
  model_field_.read_sources({stale_.begin(), stale_.end()});
  stale_.clear();
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

}  // namespace meshgrow
