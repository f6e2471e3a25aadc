#include "grid_cell.h"

#include <gtest/gtest.h>

#include "random_facets.h"

namespace meshgrow {
namespace {

double linear(const Vec3& p) { return 3.0 + 2.0 * p.x() - 5.0 * p.y() + 0.5 * p.z(); }

/// Its cells of depth 4 have the edge 0.5.
const GridCube cube{Vec3(-4, -3, -2), 8.0};

Vec3 corner(const GridCell& cell, int i) { return cube.at(cell.corner(i)); }

Vec3 lattice_point(const GridCell& cell, int i) { return cube.at(lattice_place(cell, i)); }

/// Of edge 0.5 around (1, 2, 3).
GridCell cell_of_linear_values() {
  GridCell cell;
  cell.depth = 4;
  cell.lowest = {19 * (1u << 15), 19 * (1u << 15), 19 * (1u << 15)};
  for (int i = 0; i < 8; ++i) {
    cell.corner_values[i] = linear(corner(cell, i));
  }
  return cell;
}

TEST(GridCell, CornersFollowTheBits) {
  const GridCell cell = cell_of_linear_values();
  EXPECT_EQ(corner(cell, 0), Vec3(0.75, 1.75, 2.75));
  EXPECT_EQ(corner(cell, 1), Vec3(1.25, 1.75, 2.75));
  EXPECT_EQ(corner(cell, 2), Vec3(0.75, 2.25, 2.75));
  EXPECT_EQ(corner(cell, 4), Vec3(0.75, 1.75, 3.25));
  EXPECT_EQ(corner(cell, 7), Vec3(1.25, 2.25, 3.25));
}

TEST(GridCell, LatticeContainsTheCorners) {
  const GridCell cell = cell_of_linear_values();
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(lattice_point(cell, lattice_index_of_corner(i)), corner(cell, i));
  }
  EXPECT_EQ(lattice_point(cell, 13), cell.centre(cube));
  EXPECT_EQ(cell.centre(cube), Vec3(1, 2, 3));
  EXPECT_EQ(lattice_point(cell, 1), Vec3(1.0, 1.75, 2.75));
}

TEST(GridCell, ChildrenShareTheLattice) {
  const GridCell cell = cell_of_linear_values();
  Lattice lattice;
  for (int i = 0; i < 27; ++i) {
    lattice[i] = linear(lattice_point(cell, i));
  }
  for (int child = 0; child < 8; ++child) {
    const GridCell half = child_cell(cell, child, lattice);
    EXPECT_EQ(half.half_edge(cube), 0.125);
    EXPECT_EQ(half.depth, 5);
    EXPECT_EQ(corner(half, child), corner(cell, child));
    EXPECT_EQ(corner(half, 7 - child), cell.centre(cube));
    for (int i = 0; i < 8; ++i) {
      EXPECT_EQ(half.corner_values[i], linear(corner(half, i))) << child << ", corner " << i;
    }
  }
}

TEST(GridCell, TrilinearInterpolationGivesCornersAndLinearFunctions) {
  const GridCell cell = cell_of_linear_values();
  for (int i = 0; i < 8; ++i) {
    EXPECT_DOUBLE_EQ(trilinear(cell.corner_values, i & 1 ? 1 : 0, i & 2 ? 1 : 0, i & 4 ? 1 : 0),
                     cell.corner_values[i]);
  }
  test::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 local = test::random_in_box(random, Box(Vec3::Zero(), Vec3::Ones()));
    const Vec3 p = corner(cell, 0) + 2.0 * cell.half_edge(cube) * local;
    ASSERT_NEAR(trilinear(cell.corner_values, local.x(), local.y(), local.z()), linear(p), 1e-13)
        << "seed 1";
  }
  // Not linear in the diagonal: the product term.
  const std::array<double, 8> xyz = {0, 0, 0, 0, 0, 0, 0, 8};
  EXPECT_DOUBLE_EQ(trilinear(xyz, 0.5, 0.5, 0.5), 1.0);
}

}  // namespace
}  // namespace meshgrow
