#ifndef MESHGROW_GEOMETRY_H
#define MESHGROW_GEOMETRY_H

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace meshgrow {

/// A point or vector in model units.
using Vec3 = Eigen::Vector3d;

/// An axis-aligned box in model units; default-constructed it is empty.
using Box = Eigen::AlignedBox3d;

}  // namespace meshgrow

#endif
