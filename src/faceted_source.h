#ifndef MESHGROW_FACETED_SOURCE_H
#define MESHGROW_FACETED_SOURCE_H

#include <array>
#include <vector>

#include "entity.h"
#include "geometry.h"

namespace meshgrow {

/// A source entity as pieces, before sizes are given to them: the elements of its mesh by their
/// corner nodes or pieces made from its geometry.
struct FacetedSource {
  Entity entity;
  std::vector<Vec3> points;
  std::vector<std::array<Vec3, 2>> segments;
  std::vector<std::array<Vec3, 3>> triangles;
  std::vector<std::array<Vec3, 4>> quads;  ///< corners in turn around the quad
  /// Largest curvature (1 / model units) of the geometry at each segment and triangle, where it is
  /// known: one each, NaN where not, or empty.
  std::vector<double> segment_curvatures;
  std::vector<double> triangle_curvatures;

  bool empty() const {
    return points.empty() && segments.empty() && triangles.empty() && quads.empty();
  }
};

}  // namespace meshgrow

#endif
