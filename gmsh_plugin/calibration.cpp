#include "calibration.h"

#include <algorithm>

namespace meshgrow {

namespace {

struct Entry {
  int dim;
  int algorithm;       ///< of Mesh.Algorithm or Mesh.Algorithm3D
  double inside;       ///< factor from calibration_depth on
  double at_boundary;  ///< factor at the boundary, linear in between
};

/// Printed by tests/benchmarks/calibrate.py, which says how the factors are chosen: four small
/// models per mesher, uniform and with growth rates 1.1 and 1.2, factors in steps of 0.01. In
/// comments, means over the models without and with the factors: median of edge length / size asked
/// for, share of edges within [1/√2, √2] of it, with Gmsh 4.15.2. With 4.8.4 the factors come out
/// within 0.01 (HXT's at the boundary 0.07 lower, with as many good edges), so the version does not
/// matter. 2 and 8 were measured with 4.15.2 only; 8 crashes 4.8.4, with or without a field.
///
/// Not here, so 1.0: BAMG (7) never asks the callback, not even on curves; Frontal in 3D (4) meshes
/// from its boundary and hardly asks; Packing of parallelograms (9) has no one factor that suits
/// all models.
constexpr Entry entries[] = {
    {1, 0, 1.02, 1.02},  // curves: median 0.98 -> 1.00, good 100 -> 100 %
    {2, 1, 1.06, 1.06},  // MeshAdapt: 0.95 -> 1.00, 97 -> 99 %
    {2, 2, 1.09, 1.09},  // Automatic (Delaunay on planes, else MeshAdapt): 0.94 -> 1.00, 97 -> 99 %
    {2, 5, 1.10, 1.10},  // Delaunay: 0.93 -> 1.00, 97 -> 99 %
    {2, 6, 1.03, 1.03},  // Frontal-Delaunay: 0.98 -> 1.00, 99 -> 99 %
    {2, 8, 1.04, 1.04},  // Frontal-Delaunay for quads, recombined: 1.00 -> 0.97, 86 -> 94 %
    {3, 1, 0.74, 0.53},  // Delaunay: 1.20 -> 1.00, 68 -> 97 %
    {3, 10, 0.71, 0.51},  // HXT: 1.24 -> 1.03, 63 -> 95 %
};

}  // namespace

double calibration_factor(int dim, int algorithm, double boundary_distance) {
  for (const Entry& entry : entries) {
    if (entry.dim == dim && (dim == 1 || entry.algorithm == algorithm)) {
      const double inwards = std::clamp(boundary_distance / calibration_depth, 0.0, 1.0);
      return entry.at_boundary + (entry.inside - entry.at_boundary) * inwards;
    }
  }
  return 1.0;
}

}  // namespace meshgrow
