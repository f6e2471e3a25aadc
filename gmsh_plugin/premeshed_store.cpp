#include "premeshed_store.h"

#include <algorithm>

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

std::vector<Entity> PremeshedStore::stored(const std::vector<Entity>& entities) const {
  std::vector<Entity> result;
  std::copy_if(entities.begin(), entities.end(), std::back_inserter(result),
               [this](const Entity& entity) { return contains(entity); });
  return result;
}

std::vector<Entity> PremeshedStore::keep_of_other_cells(const std::vector<Entity>& entities) {
  const std::vector<Entity> others = of_other_cells(stored(entities));
  keep(others);
  return others;
}

std::vector<Entity> PremeshedStore::misfits(const std::vector<Entity>& entities) const {
  std::vector<Entity> others = of_other_cells(stored(entities));
  const std::set<Entity> on_them = depending_on(others);
  if (std::all_of(on_them.begin(), on_them.end(),
                  [this](const Entity& entity) { return contains(entity); })) {
    others.clear();
  }
  return others;
}

void PremeshedStore::keep_only(const std::set<Entity>& entities) {
  for (auto entry = meshes_.begin(); entry != meshes_.end();) {
    entry = entities.count(entry->first) > 0 ? std::next(entry) : meshes_.erase(entry);
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
  Mesh mesh{gmsh::nodes(entity), gmsh::elements(entity), {}};
  // Gmsh gives nodes of third and higher order on curved entities no parameters, and leaves them
  // out without telling which.
  const std::size_t parameters = mesh.nodes.parametric_coordinates.size();
  if (entity.dim == 3 || parameters != mesh.nodes.tags.size() * entity.dim) {
    mesh.nodes.parametric_coordinates.clear();
  }
  if (entity.dim == 1 || entity.dim == 2) {
    mesh.periodic = gmsh::periodic_nodes(entity);
  }
  return mesh;
}

PremeshedStore::Mesh PremeshedStore::first_order(const Mesh& mesh) {
  Mesh result;
  std::set<std::size_t> between;  ///< nodes of higher order
  for (const gmsh::Elements& block : mesh.elements) {
    const gmsh::ElementType type = gmsh::element_type(block.type);
    gmsh::Elements linear;
    linear.type = gmsh::linear_type(type);
    const auto step = static_cast<std::size_t>(type.node_count);
    for (std::size_t first = 0; first + step <= block.node_tags.size(); first += step) {
      const auto begin = block.node_tags.begin() + static_cast<std::ptrdiff_t>(first);
      linear.node_tags.insert(linear.node_tags.end(), begin, begin + type.corner_count);
      between.insert(begin + type.corner_count, begin + type.node_count);
    }
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
    if (between.count(nodes.tags[i]) == 0) {
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

void PremeshedStore::write(const std::map<Entity, Mesh>& meshes) {
  // All nodes first: elements of a part of a compound also use nodes of the other parts.
  for (const auto& [entity, mesh] : meshes) {
    gmsh::add_nodes(entity, mesh.nodes);
  }
  for (const auto& [entity, mesh] : meshes) {
    std::vector<gmsh::Elements> elements = mesh.elements;
    for (gmsh::Elements& block : elements) {
      // The old tags may be taken by now; without any, Gmsh gives new ones.
      block.tags.clear();
    }
    gmsh::add_elements(entity, elements);
  }
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
  std::map<Entity, Mesh> missing;
  for (const auto& [entity, mesh] : meshes_) {
    if (!gmsh::has_elements(entity)) {
      missing[entity] = first_order(mesh);
    }
  }
  write(missing);
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

PremeshedStore::Misfits PremeshedStore::put_back() const {
  const std::vector<Entity> differing = changed();
  if (differing.empty()) {
    put_back_periodicity({});
    return {};
  }
  Misfits misfits;
  misfits.changed = of_other_cells(differing);
  // Gmsh clears no mesh on which another one stands: take those off, highest dimension first.
  const std::set<Entity> misfit = depending_on(misfits.changed);
  std::map<Entity, Mesh> laid_again;
  const std::set<Entity> touched = depending_on(differing);
  for (const Entity& entity : touched) {
    const auto stored = meshes_.find(entity);
    if (stored != meshes_.end()) {
      laid_again[entity] = stored->second;
    } else if (misfit.count(entity) > 0) {
      misfits.deleted.push_back(entity);
    } else {
      laid_again[entity] = read(entity);
    }
  }
  for (auto entity = touched.rbegin(); entity != touched.rend(); ++entity) {
    gmsh::clear_mesh({*entity});
  }
  write(laid_again);
  put_back_periodicity(laid_again);
  const std::vector<Entity> still_differing = changed();
  if (!still_differing.empty()) {
    throw Error("Gmsh changed the mesh of " + entity_names(still_differing) +
                " and it could not be put back: save the model and mesh it in smaller steps.");
  }
  return misfits;
}

void PremeshedStore::put_back_changed() const {
  const Misfits misfits = put_back();
  if (!misfits.deleted.empty()) {
    throw Error("Gmsh gave " + entity_names(misfits.changed) +
                " other elements while it meshed what lies on them, as it does with curves that "
                "intersect and with extruded layers of tetrahedra. They are put back, and the new "
                "mesh of " +
                entity_names(misfits.deleted) +
                ", which does not fit them, is deleted: ask for smaller sizes on the curves, "
                "recombine the layers, or leave those entities unmeshed.");
  }
}

void PremeshedStore::put_back_after_error() const { put_back(); }

std::set<Entity> PremeshedStore::depending_on(const std::vector<Entity>& entities) const {
  std::set<Entity> result(entities.begin(), entities.end());
  std::size_t count = 0;
  while (count != result.size()) {
    count = result.size();
    for (const Entity& entity : topology_.entities()) {
      if (result.count(entity) > 0 || !gmsh::has_elements(entity)) {
        continue;
      }
      const std::vector<Entity>& lower = topology_.lower(entity);
      const bool stands_on = std::any_of(
          lower.begin(), lower.end(), [&](const Entity& below) { return result.count(below) > 0; });
      const bool copy = (entity.dim == 1 || entity.dim == 2) &&
                        result.count({entity.dim, gmsh::periodic_nodes(entity).master}) > 0;
      if (stands_on || copy) {
        result.insert(entity);
      }
    }
  }
  return result;
}

void PremeshedStore::put_back_periodicity(const std::map<Entity, Mesh>& laid_again) const {
  std::map<Entity, gmsh::PeriodicNodes> lost;
  for (const auto& [entity, mesh] : meshes_) {
    if (!mesh.periodic.nodes.empty() && gmsh::periodic_nodes(entity).nodes.empty()) {
      lost[entity] = mesh.periodic;
    }
  }
  for (const auto& [entity, mesh] : laid_again) {
    if (!mesh.periodic.nodes.empty()) {
      lost[entity] = mesh.periodic;
    }
  }
  if (!lost.empty()) {
    gmsh::set_periodic_nodes({lost.begin(), lost.end()});
  }
}

std::multiset<std::vector<std::size_t>> PremeshedStore::cells(const Mesh& mesh) {
  std::multiset<std::vector<std::size_t>> result;
  for (const gmsh::Elements& block : mesh.elements) {
    const gmsh::ElementType type = gmsh::element_type(block.type);
    const auto step = static_cast<std::size_t>(type.node_count);
    for (std::size_t first = 0; first + step <= block.node_tags.size(); first += step) {
      const auto begin = block.node_tags.begin() + static_cast<std::ptrdiff_t>(first);
      std::vector<std::size_t> corners(begin, begin + type.corner_count);
      std::sort(corners.begin(), corners.end());
      result.insert(std::move(corners));
    }
  }
  return result;
}

std::vector<Entity> PremeshedStore::of_other_cells(const std::vector<Entity>& differing) const {
  std::vector<Entity> result;
  for (const Entity& entity : differing) {
    // No elements at all: nothing was meshed on others.
    if (gmsh::has_elements(entity) && cells(read(entity)) != cells(meshes_.at(entity))) {
      result.push_back(entity);
    }
  }
  return result;
}

}  // namespace meshgrow
