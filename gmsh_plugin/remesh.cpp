#include "remesh.h"

#include "gmsh_api.h"
#include "periodic_copies.h"

namespace meshgrow {

std::set<Entity> kept_when_meshing_again(const SizeField& field) {
  const Topology& topology = field.topology();
  std::vector<Entity> sources;
  for (const SizeFunction& function : field.functions()) {
    if (function.kind == Kind::mesh) {
      sources.insert(sources.end(), function.sources.begin(), function.sources.end());
    }
  }
  for (const Entity& entity : topology.entities()) {
    if (gmsh::is_discrete(entity)) {
      sources.push_back(entity);
    }
  }
  const std::map<Entity, Entity> masters = periodic_masters(topology);
  std::set<Entity> kept = topology.closure(sources);
  for (std::size_t before = 0; before != kept.size();) {
    before = kept.size();
    std::vector<Entity> more(kept.begin(), kept.end());
    for (const Entity& entity : kept) {
      const auto master = masters.find(entity);
      if (master != masters.end()) {
        more.push_back(master->second);
      }
    }
    kept = topology.closure(more);
  }
  for (auto entity = kept.begin(); entity != kept.end();) {
    entity = gmsh::has_elements(*entity) ? std::next(entity) : kept.erase(entity);
  }
  return kept;
}

void clear_all_but(const std::set<Entity>& kept, const SizeField& field) {
  const std::vector<Entity> all = field.topology().entities();
  for (auto entity = all.rbegin(); entity != all.rend(); ++entity) {
    if (entity->dim > 0 && kept.count(*entity) == 0 && gmsh::has_elements(*entity)) {
      gmsh::clear_mesh({*entity});
    }
  }
}

}  // namespace meshgrow
