#ifndef MESHGROW_MAPPED_SURFACE_H
#define MESHGROW_MAPPED_SURFACE_H

#include <vector>

#include "interval_matching.h"
#include "topology.h"

namespace meshgrow {

/// A mapped (transfinite) surface as Gmsh describes it.
struct MappedSurface {
  Entity surface;
  std::vector<Entity> boundary;  ///< curves in Gmsh's order
  std::vector<int> corners;      ///< tags of three or four points, or none: ends of the curves
};

/// Whether a curve is a pole, a tip or the like, by its box: Gmsh gives it no elements.
bool has_no_length(const Entity& curve, const Topology& topology);

/// The pairs of sides that need the same number of intervals: both pairs of four sides; of three
/// sides, the two at the first corner (all three with `equal_triangles`, Mesh.TransfiniteTri).
/// Curves of zero length are no sides. Nothing for surfaces that Gmsh cannot map anyway (holes,
/// seams, corners off the boundary).
std::vector<OppositeSides> opposite_sides(const MappedSurface& mapped, const Topology& topology,
                                          bool equal_triangles);

}  // namespace meshgrow

#endif
