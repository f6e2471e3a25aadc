#ifndef MESHGROW_GEOMETRY_CURVATURE_H
#define MESHGROW_GEOMETRY_CURVATURE_H

#include <vector>

#include "entity.h"

namespace meshgrow {

/// Curvatures of CAD geometry (1 / model units), by differences of its points and normals. (Gmsh's
/// own are the same for OpenCASCADE, but wrong for curves and surfaces of its built-in kernel.)

/// Curvature of a curve at parameters, by points `steps` before and behind them.
std::vector<double> curve_curvatures(const Entity& curve, const std::vector<double>& parameters,
                                     const std::vector<double>& steps);

/// Largest absolute curvature of a surface at parameters, two each, by points and normals `steps`,
/// two each, around them. NaN where the parametrisation is degenerate.
std::vector<double> surface_curvatures(const Entity& surface, const std::vector<double>& parameters,
                                       const std::vector<double>& steps);

}  // namespace meshgrow

#endif
