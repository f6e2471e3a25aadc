#ifndef MESHGROW_GRID_CELL_H
#define MESHGROW_GRID_CELL_H

#include <array>
#include <cstdint>

#include "geometry.h"

namespace meshgrow {

/// 2^-20 of the cube; a cell still undecided there asks the tree.
constexpr int max_grid_depth = 20;

/// A place of the finest lattice on a cube: 0 to 2^20 along each axis.
struct LatticePlace {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t z = 0;

  std::uint64_t key() const {
    return static_cast<std::uint64_t>(x) << 42 | static_cast<std::uint64_t>(y) << 21 | z;
  }
};

/// The cube of a background grid, and the places of its lattice: the same to the bit, whichever
/// cell asks for them.
struct GridCube {
  Vec3 origin = Vec3::Zero();
  double edge = 0.0;

  double step() const { return edge / static_cast<double>(1u << max_grid_depth); }
  Vec3 at(const LatticePlace& p) const { return origin + step() * Vec3(p.x, p.y, p.z); }
};

/// A cubic cell of the background grid. Corner i lies at the lowest corner plus the edge along x,
/// y, z by the bits 0, 1, 2 of i.
struct GridCell {
  LatticePlace lowest;
  int depth = 0;
  std::array<double, 8> corner_values{};  ///< exact sizes

  std::uint32_t steps() const { return 1u << (max_grid_depth - depth); }
  LatticePlace corner(int i) const {
    return {lowest.x + (i & 1 ? steps() : 0), lowest.y + (i & 2 ? steps() : 0),
            lowest.z + (i & 4 ? steps() : 0)};
  }
  double half_edge(const GridCube& cube) const { return 0.5 * cube.step() * steps(); }
  Vec3 centre(const GridCube& cube) const {
    return cube.origin +
           cube.step() * (Vec3(lowest.x, lowest.y, lowest.z) + Vec3::Constant(0.5 * steps()));
  }
};

/// Values at the 3 × 3 × 3 points that a cell's eight children have for corners; the point
/// (x, y, z), each 0, 1 or 2, stands at x + 3 y + 9 z.
using Lattice = std::array<double, 27>;

/// Only of a cell above the greatest depth.
inline LatticePlace lattice_place(const GridCell& cell, int i) {
  const std::uint32_t half = cell.steps() / 2;
  return {cell.lowest.x + half * static_cast<std::uint32_t>(i % 3),
          cell.lowest.y + half * static_cast<std::uint32_t>(i / 3 % 3),
          cell.lowest.z + half * static_cast<std::uint32_t>(i / 9)};
}

/// Place of a cell's corner in its lattice.
inline int lattice_index_of_corner(int corner) {
  return (corner & 1 ? 2 : 0) + (corner & 2 ? 6 : 0) + (corner & 4 ? 18 : 0);
}

/// Child `child` of the cell; its octant follows the same bits as the corners.
inline GridCell child_cell(const GridCell& cell, int child, const Lattice& lattice) {
  GridCell result;
  result.depth = cell.depth + 1;
  const int first = lattice_index_of_corner(child) / 2;
  result.lowest = lattice_place(cell, first);
  for (int i = 0; i < 8; ++i) {
    result.corner_values[i] = lattice[first + lattice_index_of_corner(i) / 2];
  }
  return result;
}

/// Trilinear interpolation of corner values at local coordinates in [0, 1]³.
template <typename Values>
double trilinear(const Values& v, double x, double y, double z) {
  const double x00 = v[0] + x * (static_cast<double>(v[1]) - v[0]);
  const double x10 = v[2] + x * (static_cast<double>(v[3]) - v[2]);
  const double x01 = v[4] + x * (static_cast<double>(v[5]) - v[4]);
  const double x11 = v[6] + x * (static_cast<double>(v[7]) - v[6]);
  const double y0 = x00 + y * (x10 - x00);
  const double y1 = x01 + y * (x11 - x01);
  return y0 + z * (y1 - y0);
}

}  // namespace meshgrow

#endif
