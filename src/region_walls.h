#ifndef MESHGROW_REGION_WALLS_H
#define MESHGROW_REGION_WALLS_H

#include <set>
#include <vector>

#include "entity.h"
#include "facet.h"
#include "faceted_source.h"

namespace meshgrow {

/// A facet on the boundary of a region (a triangle of a face of a volume, or a segment of a curve
/// of a surface), or embedded in it, seen from one side.
struct Wall {
  Facet facet;
  Vec3 inward = Vec3::Zero();  ///< unit normal into the region; of a segment, within the surface
  Entity entity;               ///< the face or curve that it is of
};

/// The walls of a volume from the triangles and quads of its faces (each face facetted by itself).
/// On which side of a face the volume lies is told by rays: a side is inside if a ray from it meets
/// the other faces an odd number of times, by the majority of several facets. Facets with a side of
/// their own do not enclose anything and are not counted. A face with the
/// volume on both sides (embedded, or a slit) gives two walls a facet. Facets within a face may be
/// oriented either way. Facets without area are left out.
std::vector<Wall> volume_walls(const std::vector<FacetedSource>& faces);

/// The walls of a surface from its triangles and quads and the segments of the curves on its
/// boundary or embedded in it: a segment that is a side of one or more triangles gives one wall for
/// each, looking towards the triangle. Sides and segments are the same where their ends are equal
/// to the bit. Curves in `seams` are no walls: the surface is the same beyond them.
std::vector<Wall> surface_walls(const FacetedSource& surface,
                                const std::vector<FacetedSource>& curves,
                                const std::set<Entity>& seams);

}  // namespace meshgrow

#endif
