#include "premeshed_store.h"

#include "error.h"

namespace meshgrow {

PremeshedStore::PremeshedStore(const Topology& topology) : topology_(topology) {
  keep(topology.entities());
}

void PremeshedStore::keep(const std::vector<Entity>& entities) {
  for (const Entity& entity : entities) {
    if (gmsh::has_elements(entity)) {
      meshes_[entity] = read(entity);
    }
  }
}

std::set<Entity> PremeshedStore::entities() const {
  std::set<Entity> result;
  for (const auto& [entity, mesh] : meshes_) {
    result.insert(entity);
  }
  return result;
}

PremeshedStore::Mesh PremeshedStore::read(const Entity& entity) {
  return {gmsh::nodes(entity), gmsh::elements(entity)};
}

PremeshedStore::Mesh PremeshedStore::first_order(const Mesh& mesh) {
  Mesh result;
  std::set<std::size_t> corners;
  for (const gmsh::Elements& block : mesh.elements) {
    const gmsh::ElementType type = gmsh::element_type(block.type);
    gmsh::Elements linear;
    linear.type = gmsh::linear_type(type);
    const auto step = static_cast<std::size_t>(type.node_count);
    for (std::size_t first = 0; first + step <= block.node_tags.size(); first += step) {
      const auto begin = block.node_tags.begin() + static_cast<std::ptrdiff_t>(first);
      linear.node_tags.insert(linear.node_tags.end(), begin, begin + type.corner_count);
    }
    corners.insert(linear.node_tags.begin(), linear.node_tags.end());
    result.elements.push_back(std::move(linear));
  }
  const gmsh::Nodes& nodes = mesh.nodes;
  const auto copy = [](const std::vector<double>& from, std::size_t i, std::size_t width,
                       std::vector<double>& to) {
    const auto begin = from.begin() + static_cast<std::ptrdiff_t>(i * width);
    to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
  };
  const std::size_t parameters =
      nodes.tags.empty() ? 0 : nodes.parametric_coordinates.size() / nodes.tags.size();
  for (std::size_t i = 0; i < nodes.tags.size(); ++i) {
    if (corners.count(nodes.tags[i]) > 0) {
      result.nodes.tags.push_back(nodes.tags[i]);
      copy(nodes.coordinates, i, 3, result.nodes.coordinates);
      copy(nodes.parametric_coordinates, i, parameters, result.nodes.parametric_coordinates);
    }
  }
  return result;
}

std::optional<Entity> PremeshedStore::any_of_higher_order() const {
  for (const auto& [entity, mesh] : meshes_) {
    for (const gmsh::Elements& block : mesh.elements) {
      const gmsh::ElementType type = gmsh::element_type(block.type);
      if (type.node_count > type.corner_count) {
        return entity;
      }
    }
  }
  return std::nullopt;
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
      write(entity, first_order(mesh));
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
    if (!gmsh::has_elements(entity)) {
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
