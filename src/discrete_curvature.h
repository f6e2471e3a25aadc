#ifndef MESHGROW_DISCRETE_CURVATURE_H
#define MESHGROW_DISCRETE_CURVATURE_H

#include <array>
#include <vector>

#include "geometry.h"

namespace meshgrow {

/// Where neighbouring facets turn by more degrees than this, there is an edge, not curvature.
constexpr double crease_angle = 40.0;

/// Curvature (1 / model units, ≥ 0) at each segment of a curve that is given by its segments in any
/// order and direction: the larger one of its two ends, each the inverse radius of the circle
/// through three neighbouring points. Ends, branches and corners of more than `crease_angle` have
/// none. Segments share a point where coordinates are equal to the bit. Thread-safe.
std::vector<double> segment_curvatures(const std::vector<std::array<Vec3, 2>>& segments);

/// Largest absolute curvature (1 / model units) at each triangle of a surface that is given by
/// triangles in any order and orientation, such as an STL: from the normals at the triangles'
/// corners, which are exact for regular facetings of cylinders and spheres. Corners at creases have
/// one normal for each smooth side; edges of one, or of more than two triangles end a side.
/// Degenerate triangles have 0. Triangles share a corner where coordinates are equal to the bit.
/// Fewer than 7e8 triangles. Thread-safe.
std::vector<double> triangle_curvatures(const std::vector<std::array<Vec3, 3>>& triangles);

}  // namespace meshgrow

#endif
