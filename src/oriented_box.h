#ifndef MESHGROW_ORIENTED_BOX_H
#define MESHGROW_ORIENTED_BOX_H

#include <cstddef>

#include "geometry.h"

namespace meshgrow {

/// How points are spread: enough for their principal axes.
struct Spread {
  double count = 0.0;
  Vec3 sum = Vec3::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();

  void add(const Vec3& p) {
    count += 1.0;
    sum += p;
    products += p * p.transpose();
  }
  void add(const Spread& other) {
    count += other.count;
    sum += other.sum;
    products += other.products;
  }
};

/// A box that lies as what is in it: flat around a piece of a surface, thin around a piece of a
/// curve. Its distance from a point is hardly below that of what is inside.
struct OrientedBox {
  Vec3 centre = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, right-handed
  Vec3 half_sizes = Vec3::Zero();                      ///< along the axes
};

/// Around points with the given box along the axes of coordinates; they lie about across the axis,
/// or along it, which need not be a unit vector.
OrientedBox oriented_box(const Vec3* points, std::size_t count, const Vec3& axis, const Box& box);

/// The same without an axis.
OrientedBox oriented_box(const Vec3* points, std::size_t count, const Spread& spread,
                         const Box& box);

/// Around boxes with the given spread and box of what is in them.
OrientedBox oriented_box(const OrientedBox* boxes, std::size_t count, const Spread& spread,
                         const Box& box);

}  // namespace meshgrow

#endif
