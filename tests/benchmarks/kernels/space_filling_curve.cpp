#include "space_filling_curve.h"

#include <algorithm>
#include <array>
#include <utility>

namespace meshgrow::kernels {

namespace {

constexpr int bits = 20;

/// Coordinates to the transposed Hilbert index (Skilling: Programming the Hilbert curve, AIP
/// Conference Proceedings 707, 2004).
void to_transposed_index(std::array<std::uint32_t, 3>& x) {
  constexpr std::uint32_t top = 1U << (bits - 1);
  for (std::uint32_t q = top; q > 1; q >>= 1) {
    const std::uint32_t below = q - 1;
    for (std::uint32_t& coordinate : x) {
      if ((coordinate & q) != 0) {
        x[0] ^= below;
      } else {
        const std::uint32_t exchanged = (x[0] ^ coordinate) & below;
        x[0] ^= exchanged;
        coordinate ^= exchanged;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t flips = 0;
  for (std::uint32_t q = top; q > 1; q >>= 1) {
    if ((x[2] & q) != 0) {
      flips ^= q - 1;
    }
  }
  for (std::uint32_t& coordinate : x) {
    coordinate ^= flips;
  }
}

}  // namespace

std::uint64_t hilbert_index(const Vec3& p, const Box& box) {
  constexpr double cells = 1U << bits;
  const double edge = std::max(box.sizes().maxCoeff(), 1e-300);
  std::array<std::uint32_t, 3> x;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = (p[axis] - box.min()[axis]) / edge * cells;
    x[axis] = static_cast<std::uint32_t>(std::clamp(cell, 0.0, cells - 1.0));
  }
  to_transposed_index(x);
  std::uint64_t index = 0;
  for (int bit = bits - 1; bit >= 0; --bit) {
    for (const std::uint32_t coordinate : x) {
      index = index << 1 | (coordinate >> bit & 1U);
    }
  }
  return index;
}

std::vector<std::uint32_t> hilbert_order(const std::vector<Vec3>& points, const Box& box) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  keys.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    keys.emplace_back(hilbert_index(points[i], box), static_cast<std::uint32_t>(i));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order;
  order.reserve(keys.size());
  for (const auto& key : keys) {
    order.push_back(key.second);
  }
  return order;
}

std::vector<Vec3> along_curve(const std::vector<Vec3>& points, const Box& box) {
  std::vector<Vec3> sorted;
  sorted.reserve(points.size());
  for (const std::uint32_t i : hilbert_order(points, box)) {
    sorted.push_back(points[i]);
  }
  return sorted;
}

}  // namespace meshgrow::kernels
