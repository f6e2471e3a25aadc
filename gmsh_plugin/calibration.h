#ifndef MESHGROW_CALIBRATION_H
#define MESHGROW_CALIBRATION_H

namespace meshgrow {

/// What a size is multiplied by so that Gmsh's edges have the length asked for in the middle.
/// `algorithm` is Mesh.Algorithm for dimension 2, Mesh.Algorithm3D for 3.
double calibration_factor(int dim, int algorithm);

}  // namespace meshgrow

#endif
