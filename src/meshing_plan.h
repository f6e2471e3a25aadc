#ifndef MESHGROW_MESHING_PLAN_H
#define MESHGROW_MESHING_PLAN_H

#include <map>
#include <set>
#include <string>
#include <vector>

#include "size_function.h"
#include "topology.h"

namespace meshgrow {

/// One call of Gmsh's mesher: entities of one dimension, all of which some effective size function
/// acts on (`attached`), or none.
struct MeshingPass {
  int stage = 0;  ///< passes of one stage do not depend on each other
  int dim = 1;
  bool attached = false;
  std::vector<Entity> entities;        ///< sorted
  std::vector<std::size_t> functions;  ///< that act in this pass, by index
  std::vector<Entity> sources;         ///< of these functions, read before this pass for the first
                                       ///< time
};

/// What is to be meshed.
struct MeshingTask {
  const Topology& topology;
  const std::vector<SizeFunction>& functions;
  std::set<Entity> meshed;  ///< what has a mesh and keeps it
  /// Entities whose meshes depend on each other, such as opposite sides of a mapped surface: each
  /// set is meshed in one stage unless one of them has to wait for another.
  std::vector<std::vector<Entity>> together;
  /// Periodic entities, each with the one that it is a copy of: it comes after that, whatever the
  /// sizes, and waits for no source.
  std::map<Entity, Entity> masters;
  /// Entities that Gmsh meshes along with others, whatever the sizes: they wait for no source.
  std::set<Entity> companions;
};

/// The closure of these entities together with the masters of all periodic copies in it, and the
/// closures of those.
std::set<Entity> closure_with_masters(std::vector<Entity> entities, const Topology& topology,
                                      const std::map<Entity, Entity>& masters);

/// Orders everything up to dimension `dim` that has no mesh into passes (paper, sections 1, 5.1 and
/// 5.2): an entity comes after its boundary and what is embedded in it, and after all sources of
/// the mesh size functions that act on it. The sources of one function, with all below them, do not
/// wait for each other; sources of fixed functions need no mesh and are not waited for. Surfaces
/// are left until all curves are done unless a curve waits for them, since a pass over curves costs
/// surfaces their mesh. Throws Error that tells the cycle in words if there is one.
std::vector<MeshingPass> plan_meshing(const MeshingTask& task, int dim);

/// The passes as a table for people.
std::string plan_text(const std::vector<MeshingPass>& plan,
                      const std::vector<SizeFunction>& functions);

}  // namespace meshgrow

#endif
