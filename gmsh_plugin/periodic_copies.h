#ifndef MESHGROW_PERIODIC_COPIES_H
#define MESHGROW_PERIODIC_COPIES_H

#include <map>

#include "topology.h"

namespace meshgrow {

/// Periodic curves and surfaces of the current model, each with the one that it is a copy of, its
/// master. Those that Gmsh knows no transformation for are left out.
std::map<Entity, Entity> periodic_masters(const Topology& topology);

/// Gives a periodic curve or surface the mesh of its master, moved, in first order, and tells Gmsh
/// which nodes correspond. Gmsh itself copies only what it meshed in the same pass. The boundary
/// must have its mesh already. Throws Error if the boundary does not match the master's.
void copy_from_master(const Entity& copy, const Entity& master, const Topology& topology);

}  // namespace meshgrow

#endif
