// What an OrderedMesher refuses or warns of.

#include <algorithm>
#include <map>

#include "error.h"
#include "gmsh_api.h"
#include "meshing_plan.h"
#include "ordered_mesher.h"

namespace meshgrow {

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
