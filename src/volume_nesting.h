#ifndef MESHGROW_VOLUME_NESTING_H
#define MESHGROW_VOLUME_NESTING_H

#include <set>
#include <vector>

#include "topology.h"

namespace meshgrow {

/// Volumes that lie in cavities of `volume`: those whose faces, but for faces between themselves,
/// all bound `volume` as well.
std::set<Entity> enclosed_volumes(const Entity& volume, const Topology& topology);

/// Splits volumes into passes of Gmsh: a pass holds only volumes that are in `attached`, or only
/// others, and comes after the passes of differing volumes in cavities of its own. Gmsh meshes an
/// unmeshed volume in a cavity along with the one around it, whether asked to or not (DESIGN.md,
/// section 5, line 4); without elements of its own it is badly meshed, and that takes minutes.
std::vector<std::vector<Entity>> volume_passes(const std::vector<Entity>& volumes,
                                               const std::set<Entity>& attached,
                                               const Topology& topology);

}  // namespace meshgrow

#endif
