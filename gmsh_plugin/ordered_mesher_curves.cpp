// What an OrderedMesher does about curves that change after their pass: Gmsh splits some under
// surfaces, and those of mapped surfaces are adjusted to each other.

#include <algorithm>
#include <map>

#include "gmsh_api.h"
#include "ordered_mesher.h"

namespace meshgrow {

namespace {

/// Times that the run is started again because Gmsh has split curves.
constexpr int most_splits = 4;

}  // namespace

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

}  // namespace meshgrow
