#ifndef MESHGROW_TOPOLOGY_H
#define MESHGROW_TOPOLOGY_H

#include <map>
#include <set>
#include <string>
#include <vector>

#include "entity.h"
#include "geometry.h"

namespace meshgrow {

/// A physical group of a model: its own dimension, tag and name (empty if it has none).
struct PhysicalGroup {
  int dim = 0;
  int tag = 0;
  std::string name;
  std::vector<Entity> entities;
};

/// The entities of a model, what bounds them and what is embedded in them. Filled once, then read
/// from any thread.
class Topology {
 public:
  /// `lower`: the entities one dimension below on the boundary, and those embedded, of any lower
  /// dimension. `box` in model units; may be empty.
  void add_entity(const Entity& entity, std::vector<Entity> lower, const Box& box = Box());
  void add_physical_group(PhysicalGroup group);

  bool contains(const Entity& entity) const { return entities_.count(entity) > 0; }
  std::vector<Entity> entities() const;
  std::vector<Entity> entities(int dim) const;
  const std::vector<PhysicalGroup>& physical_groups() const { return physical_groups_; }

  /// Boundary and embedded entities, one step down. The entity must exist.
  const std::vector<Entity>& lower(const Entity& entity) const;
  const Box& box(const Entity& entity) const;

  /// The entities themselves and everything below them: boundaries, boundaries of boundaries,
  /// embedded entities and theirs.
  std::set<Entity> closure(const std::vector<Entity>& entities) const;

 private:
  struct Node {
    std::vector<Entity> lower;
    Box box;
  };
  const Node& node(const Entity& entity) const;

  std::map<Entity, Node> entities_;
  std::vector<PhysicalGroup> physical_groups_;
};

}  // namespace meshgrow

#endif
