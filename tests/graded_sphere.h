#ifndef MESHGROW_TESTS_GRADED_SPHERE_H
#define MESHGROW_TESTS_GRADED_SPHERE_H

#include <array>
#include <cmath>
#include <vector>

#include "geometry.h"

namespace meshgrow::test {

/// Triangles of a unit sphere whose sizes grow from one pole to the other, about `ratio` : 1. About
/// `triangle_count` of them, by rings of latitude whose spacing follows the size.
inline std::vector<std::array<Vec3, 3>> graded_sphere(std::size_t triangle_count, double ratio) {
  const double pi = std::acos(-1.0);
  const auto rings_at = [&](double scale) {
    std::vector<std::vector<Vec3>> rings;
    const auto size = [&](double theta) { return scale * std::pow(ratio, theta / pi); };
    double theta = 0.5 * size(0.0);
    while (theta < pi - 0.5 * size(theta)) {
      const auto count = std::max<std::size_t>(
          6, static_cast<std::size_t>(2.0 * pi * std::sin(theta) / size(theta)));
      std::vector<Vec3> ring;
      for (std::size_t i = 0; i < count; ++i) {
        const double phi = 2.0 * pi * static_cast<double>(i) / static_cast<double>(count);
        ring.emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                          std::cos(theta));
      }
      rings.push_back(ring);
      theta += 0.87 * size(theta);
    }
    return rings;
  };
  const auto count_of = [](const std::vector<std::vector<Vec3>>& rings) {
    std::size_t count = rings.front().size() + rings.back().size();
    for (std::size_t r = 1; r < rings.size(); ++r) {
      count += rings[r - 1].size() + rings[r].size();
    }
    return count;
  };
  double low = 1e-6;
  double high = 0.3;
  for (int i = 0; i < 30; ++i) {
    const double middle = std::sqrt(low * high);
    // A cheap estimate of the count avoids building rings far below the wanted size.
    const double estimate = 4.0 * pi / (0.43 * middle * middle * ratio);
    const bool too_many = estimate > 20.0 * static_cast<double>(triangle_count) ||
                          count_of(rings_at(middle)) > triangle_count;
    (too_many ? low : high) = middle;
  }
  const auto rings = rings_at(high);
  std::vector<std::array<Vec3, 3>> triangles;
  const auto fan = [&](const Vec3& pole, const std::vector<Vec3>& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      triangles.push_back({pole, ring[i], ring[(i + 1) % ring.size()]});
    }
  };
  fan(Vec3(0, 0, 1), rings.front());
  for (std::size_t r = 1; r < rings.size(); ++r) {
    const auto& a = rings[r - 1];
    const auto& b = rings[r];
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() || j < b.size()) {
      const double next_a = static_cast<double>(i + 1) / static_cast<double>(a.size());
      const double next_b = static_cast<double>(j + 1) / static_cast<double>(b.size());
      if (i < a.size() && (j == b.size() || next_a <= next_b)) {
        triangles.push_back({a[i], a[(i + 1) % a.size()], b[j % b.size()]});
        ++i;
      } else {
        triangles.push_back({b[j], b[(j + 1) % b.size()], a[i % a.size()]});
        ++j;
      }
    }
  }
  fan(Vec3(0, 0, -1), rings.back());
  return triangles;
}

}  // namespace meshgrow::test

#endif
