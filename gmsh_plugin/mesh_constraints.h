#ifndef MESHGROW_MESH_CONSTRAINTS_H
#define MESHGROW_MESH_CONSTRAINTS_H

#include <map>
#include <set>
#include <string>
#include <vector>

#include "mapped_surface.h"
#include "topology.h"

namespace meshgrow {

/// What the user has prescribed for the mesh of entities, besides sizes.
struct MeshConstraints {
  std::map<Entity, int> prescribed_intervals;  ///< of transfinite curves
  std::vector<MappedSurface> mapped_surfaces;  ///< transfinite ones
  std::set<Entity> recombined_surfaces;
  std::vector<Entity> mapped_volumes;  ///< transfinite ones
};

/// Reads them from Gmsh's current model. Gmsh's interface sets transfinite constraints but does not
/// tell them; the unrolled .geo text that it writes does, so that is written to a temporary file
/// and read. (Of curves it leaves out arcs below 180 degrees of OpenCASCADE.)
MeshConstraints read_mesh_constraints(const Topology& topology);

/// What unrolled .geo text says about transfinite and recombined entities; `boundary` of the
/// surfaces is left empty.
MeshConstraints parse_unrolled_geo(const std::string& text);

}  // namespace meshgrow

#endif
