// How an OrderedMesher keeps faces whose meshes later passes of Gmsh would take away.

#include <algorithm>
#include <iterator>

#include "error.h"
#include "gmsh_api.h"
#include "ordered_mesher.h"

namespace meshgrow {

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

}  // namespace meshgrow
