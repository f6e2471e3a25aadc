#ifndef MESHGROW_CALIBRATION_H
#define MESHGROW_CALIBRATION_H

#include <limits>

namespace meshgrow {

/// Gmsh's edges are not as long as the sizes that it is told: in volumes their median is 1.3 to 1.4
/// times the size. A calibrated field tells Gmsh the size asked for times this factor, so that the
/// median comes out near 1 and the most edges within [1/√2, √2] of the size asked for.
///
/// `algorithm` is Gmsh's number of the mesher: Mesh.Algorithm for dim 2, Mesh.Algorithm3D for dim
/// 3, ignored for dim 1. 1.0 for meshers that are unknown or do not ask for sizes.
///
/// `boundary_distance` is the distance to the mesh on the boundary of the volume, in sizes asked
/// for. It matters in volumes only, up to `calibration_depth`: the nodes of the boundary are given,
/// spaced by the sizes asked for, and Gmsh keeps the first layer of nodes too far from them unless
/// the size told there is smaller still.
double calibration_factor(int dim, int algorithm,
                          double boundary_distance = std::numeric_limits<double>::infinity());

/// From here on, in sizes asked for, the factor does not depend on the distance.
constexpr double calibration_depth = 1.2;

}  // namespace meshgrow

#endif
