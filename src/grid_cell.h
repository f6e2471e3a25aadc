#ifndef MESHGROW_GRID_CELL_H
#define MESHGROW_GRID_CELL_H

#include <array>

#include "geometry.h"

namespace meshgrow {

/// A cubic cell of the background grid. Corner i lies at the centre ± half_edge along x, y, z by
/// the bits 0, 1, 2 of i.
struct GridCell {
  Vec3 centre;
  double half_edge = 0.0;
  int depth = 0;
  std::array<double, 8> corner_values{};  ///< exact sizes

  Vec3 corner(int i) const {
    return centre + half_edge * Vec3(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
  }
};

/// Values at the 3 × 3 × 3 points that a cell's eight children have for corners; the point
/// (x, y, z), each 0, 1 or 2, stands at x + 3 y + 9 z.
using Lattice = std::array<double, 27>;

inline Vec3 lattice_point(const GridCell& cell, int i) {
  return cell.centre + cell.half_edge * Vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
}

/// Place of a cell's corner in its lattice.
inline int lattice_index_of_corner(int corner) {
  return (corner & 1 ? 2 : 0) + (corner & 2 ? 6 : 0) + (corner & 4 ? 18 : 0);
}

/// Child `child` of the cell; its octant follows the same bits as the corners.
inline GridCell child_cell(const GridCell& cell, int child, const Lattice& lattice) {
  GridCell result;
  result.half_edge = 0.5 * cell.half_edge;
  result.depth = cell.depth + 1;
  result.centre = 0.5 * (cell.centre + cell.corner(child));
  const int first = lattice_index_of_corner(child) / 2;
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
