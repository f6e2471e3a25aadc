#ifndef MESHGROW_BENCHMARKS_KERNELS_SPACE_FILLING_CURVE_H
#define MESHGROW_BENCHMARKS_KERNELS_SPACE_FILLING_CURVE_H

#include <cstdint>
#include <vector>

#include "geometry.h"

namespace meshgrow::kernels {

/// Position of p on a Hilbert curve through the cube around the box, 20 bits an axis.
std::uint64_t hilbert_index(const Vec3& p, const Box& box);

/// The order in which the curve meets the points.
std::vector<std::uint32_t> hilbert_order(const std::vector<Vec3>& points, const Box& box);

/// The points in the curve's order.
std::vector<Vec3> along_curve(const std::vector<Vec3>& points, const Box& box);

}  // namespace meshgrow::kernels

#endif
