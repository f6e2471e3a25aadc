#include "oriented_box.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace meshgrow {

namespace {

const Vec3& centre_of(const Vec3& p) { return p; }
const Vec3& centre_of(const OrientedBox& box) { return box.centre; }

/// Half the lengths of a thing along the axes.
Vec3 reach_of(const Vec3&, const Eigen::Matrix3d&) { return Vec3::Zero(); }
Vec3 reach_of(const OrientedBox& box, const Eigen::Matrix3d& axes) {
  return (axes.transpose() * box.axes).cwiseAbs() * box.half_sizes;
}

template <typename Thing>
OrientedBox box_along(const Eigen::Matrix3d& axes, const Thing* things, std::size_t count) {
  Vec3 lower = Vec3::Constant(1e300);
  Vec3 upper = -lower;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 place = axes.transpose() * centre_of(things[i]);
    const Vec3 reach = reach_of(things[i], axes);
    lower = lower.cwiseMin(place - reach);
    upper = upper.cwiseMax(place + reach);
  }
  return {axes * (0.5 * (lower + upper)), axes, 0.5 * (upper - lower)};
}

/// Half the surface: it tells flat boxes apart, and thin ones.
double surface(const OrientedBox& box) {
  const Vec3& s = box.half_sizes;
  return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}

template <typename Thing>
OrientedBox smallest_box(const Thing* things, std::size_t count, const Spread& spread,
                         const Box& box) {
  OrientedBox best{box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.sizes()};
  const auto try_axes = [&](const Eigen::Matrix3d& axes) {
    const OrientedBox other = box_along(axes, things, count);
    if (surface(other) < surface(best)) {
      best = other;
    }
  };
  const Vec3 mean = spread.sum / spread.count;
  const Eigen::Matrix3d covariance = spread.products / spread.count - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal;
  principal.computeDirect(covariance);  // by rising spread
  Eigen::Matrix3d axes = principal.eigenvectors();
  if (!axes.allFinite() || !axes.isUnitary(1e-9)) {
    return best;
  }
  axes.col(2) = axes.col(0).cross(axes.col(1));
  try_axes(axes);
  // The tree cuts pieces of a surface along the axes of coordinates.
  const Vec3 normal = axes.col(0);
  for (int k = 0; k < 3; ++k) {
    const Vec3 side = normal.cross(Vec3::Unit(k));
    if (side.norm() > 0.3) {
      axes.col(1) = side.normalized();
      axes.col(2) = normal.cross(axes.col(1));
      try_axes(axes);
    }
  }
  return best;
}

}  // namespace

OrientedBox oriented_box(const Vec3* points, std::size_t count, const Spread& spread,
                         const Box& box) {
  return smallest_box(points, count, spread, box);
}

OrientedBox oriented_box(const Vec3* points, std::size_t count, const Vec3& axis, const Box& box) {
  const OrientedBox upright{box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.sizes()};
  Eigen::Matrix3d axes;
  axes.col(0) = axis.normalized();
  // The tree cuts pieces of a surface along the axes of coordinates.
  int flattest = 0;
  axes.col(0).cwiseAbs().minCoeff(&flattest);
  axes.col(1) = axes.col(0).cross(Vec3::Unit(flattest)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  const OrientedBox oblique = box_along(axes, points, count);
  return surface(oblique) < surface(upright) ? oblique : upright;
}

OrientedBox oriented_box(const OrientedBox* boxes, std::size_t count, const Spread& spread,
                         const Box& box) {
  return smallest_box(boxes, count, spread, box);
}

}  // namespace meshgrow
