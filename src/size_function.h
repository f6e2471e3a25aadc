#ifndef MESHGROW_SIZE_FUNCTION_H
#define MESHGROW_SIZE_FUNCTION_H

#include <set>
#include <string>
#include <vector>

#include "entity.h"
#include "sized_facets.h"
#include "topology.h"

namespace meshgrow {

/// What the start sizes on the sources come from (paper, sections 2 and 3). The kinds differ in
/// nothing else.
enum class Kind {
  mesh,       ///< the mesh that is already on the sources
  fixed,      ///< one given size
  curvature,  ///< the curvature of the sources
  proximity   ///< the gaps between the sources and what is opposite, through the attachments
};

/// "mesh", "fixed", "curvature", "proximity".
std::string kind_name(Kind kind);

/// Between which walls a proximity size function measures gaps.
enum class GapsBetween {
  automatic,  ///< faces where volumes are attached and a source is a face or volume, else edges
  faces,      ///< faces of attached volumes
  edges,      ///< curves of surfaces that are attached or bound an attached volume
  both
};

/// One definition of a size function (paper, section 2).
struct SizeFunction {
  Kind kind = Kind::mesh;
  std::string name;  ///< of this one among those of a field; empty: the field gives it a number
  /// mesh: curves, surfaces; fixed: also points and volumes; curvature and proximity: curves,
  /// surfaces, and volumes, which stand for their faces.
  std::vector<Entity> sources;
  std::vector<Entity> attachments;  ///< curves, surfaces, volumes; acts on their boundaries as well
  double growth_rate = 1.2;  ///< each layer of elements is so many times the one before, ≥ 1
  double size_limit = 0.0;   ///< largest size asked for, model units, > 0
  double start_size = 0.0;   ///< fixed: size on the sources, model units, > 0
  QuadSize quad_size = QuadSize::triangles;  ///< mesh: how quadrilaterals are sized
  double angle = 18.0;         ///< curvature: degrees that an edge of an element may turn by
  double cells_per_gap = 3.0;  ///< proximity: elements across a gap, > 0, need not be whole
  GapsBetween between = GapsBetween::automatic;  ///< proximity
  double min_size = 0.0;  ///< model units. curvature: the smallest start size; proximity: gaps that
                          ///< ask for less are ignored
};

/// The curves and surfaces that a curvature size function measures: volumes stand for their faces,
/// and surfaces, in models without volumes, for their curves as well.
std::set<Entity> curvature_sources(const SizeFunction& function, const Topology& topology);

/// An attached volume in which a proximity size function measures gaps between faces, or a surface
/// in which it does between curves.
struct GapRegion {
  Entity region;
  std::set<Entity> sources;  ///< on its boundary or embedded in it, one dimension below
};
std::vector<GapRegion> gap_regions(const SizeFunction& function, const Topology& topology);

/// Whether a field gave the name: digits alone.
bool is_number_name(const std::string& name);

/// "Mesh size function 1" or "Mesh size function "inner"", as messages name it; the function with
/// this index, if it has no name yet.
std::string function_name(const SizeFunction& function, std::size_t index);

/// Throws Error with one sentence, beginning with `name`, unless the parameters are usable, all
/// entities are in the model, no source of a mesh size function is its own attachment, and a
/// proximity size function has a gap to measure.
void validate(const SizeFunction& function, const std::string& name, const Topology& topology);

}  // namespace meshgrow

#endif
