#include "topology.h"

#include "error.h"

namespace meshgrow {

void Topology::add_entity(const Entity& entity, std::vector<Entity> lower, const Box& box) {
  entities_[entity] = {std::move(lower), box};
}

void Topology::add_physical_group(PhysicalGroup group) {
  physical_groups_.push_back(std::move(group));
}

std::vector<Entity> Topology::entities() const {
  std::vector<Entity> result;
  for (const auto& [entity, node] : entities_) {
    result.push_back(entity);
  }
  return result;
}

std::vector<Entity> Topology::entities(int dim) const {
  std::vector<Entity> result;
  for (const auto& [entity, node] : entities_) {
    if (entity.dim == dim) {
      result.push_back(entity);
    }
  }
  return result;
}

const Topology::Node& Topology::node(const Entity& entity) const {
  const auto found = entities_.find(entity);
  if (found == entities_.end()) {
    throw Error(entity_name(entity) + " is not in the model: check its dimension and tag.");
  }
  return found->second;
}

const std::vector<Entity>& Topology::lower(const Entity& entity) const {
  return node(entity).lower;
}

const Box& Topology::box(const Entity& entity) const { return node(entity).box; }

std::set<Entity> Topology::closure(const std::vector<Entity>& entities) const {
  std::set<Entity> result;
  std::vector<Entity> open = entities;
  while (!open.empty()) {
    const Entity entity = open.back();
    open.pop_back();
    if (result.insert(entity).second) {
      const std::vector<Entity>& below = lower(entity);
      open.insert(open.end(), below.begin(), below.end());
    }
  }
  return result;
}

}  // namespace meshgrow
