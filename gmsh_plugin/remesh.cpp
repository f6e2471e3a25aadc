#include "remesh.h"

#include "gmsh_api.h"
#include "meshing_plan.h"
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
  std::set<Entity> kept = closure_with_masters(sources, topology, periodic_masters(topology));
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
