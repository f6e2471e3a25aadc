#include "premeshed_store.h"

#include "error.h"

namespace meshgrow {

PremeshedStore::PremeshedStore(const Topology& topology) : topology_(topology) {
  keep(topology.entities());
}

void PremeshedStore::keep(const std::vector<Entity>& entities) {
  for (const Entity& entity : entities) {
    if (entity.dim > 0 && gmsh::has_elements(entity)) {
      meshes_[entity] = read(entity);
    }
  }
}

PremeshedStore::Mesh PremeshedStore::read(const Entity& entity) {
  return {gmsh::nodes(entity), gmsh::elements(entity)};
}

void PremeshedStore::write(const Entity& entity, const Mesh& mesh) {
  gmsh::add_nodes(entity, mesh.nodes);
  std::vector<gmsh::Elements> elements = mesh.elements;
  for (gmsh::Elements& block : elements) {
    // The old tags may be taken by now; without any, Gmsh gives new ones.
    block.tags.clear();
  }
  gmsh::add_elements(entity, elements);
}

bool PremeshedStore::same(const Mesh& a, const Mesh& b) {
  if (a.nodes.tags != b.nodes.tags || a.nodes.coordinates != b.nodes.coordinates ||
      a.elements.size() != b.elements.size()) {
    return false;
  }
  for (std::size_t i = 0; i < a.elements.size(); ++i) {
    if (a.elements[i].type != b.elements[i].type ||
        a.elements[i].node_tags != b.elements[i].node_tags) {
      return false;
    }
  }
  return true;
}

void PremeshedStore::put_back_missing() const {
  for (const auto& [entity, mesh] : meshes_) {
    if (!gmsh::has_elements(entity)) {
      write(entity, mesh);
    }
  }
}

std::vector<Entity> PremeshedStore::changed() const {
  std::vector<Entity> result;
  for (const auto& [entity, mesh] : meshes_) {
    if (!same(read(entity), mesh)) {
      result.push_back(entity);
    }
  }
  return result;
}

void PremeshedStore::put_back_changed() const {
  const std::vector<Entity> differing = changed();
  if (differing.empty()) {
    return;
  }
  // Gmsh clears no mesh on which another one stands: take those off, highest dimension first.
  std::map<Entity, Mesh> laid_again;
  for (const Entity& entity : topology_.entities()) {
    if (entity.dim == 0 || !gmsh::has_elements(entity)) {
      continue;
    }
    const std::set<Entity> closure = topology_.closure({entity});
    for (const Entity& below : differing) {
      if (closure.count(below) > 0) {
        const auto stored = meshes_.find(entity);
        laid_again[entity] = stored != meshes_.end() ? stored->second : read(entity);
        break;
      }
    }
  }
  for (auto entry = laid_again.rbegin(); entry != laid_again.rend(); ++entry) {
    gmsh::clear_mesh({entry->first});
  }
  for (const Entity& entity : differing) {
    laid_again[entity] = meshes_.at(entity);
  }
  for (const auto& [entity, mesh] : laid_again) {
    write(entity, mesh);
  }
  const std::vector<Entity> still_differing = changed();
  if (!still_differing.empty()) {
    throw Error("Gmsh changed the mesh of " + entity_names(still_differing) +
                " and it could not be put back: save the model and mesh it in smaller steps.");
  }
}

}  // namespace meshgrow
