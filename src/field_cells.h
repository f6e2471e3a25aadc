#ifndef MESHGROW_FIELD_CELLS_H
#define MESHGROW_FIELD_CELLS_H

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "size_field.h"

namespace meshgrow {

/// A cubic cell of a size field with the sizes at its corners (order as of GridCell).
struct FieldCell {
  LatticePlace lowest;
  std::uint8_t depth = 0;
  /// The field answers from facets in it; what is interpolated between its corners only shows it.
  bool exact = false;
  std::uint32_t group = 0;  ///< index into SizeField::groups() of the one that decides
  std::array<float, 8> sizes{};
};

/// A size field as cells that other programs can show and interpolate.
struct FieldCells {
  GridCube cube;
  std::vector<FieldCell> cells;

  LatticePlace corner_place(const FieldCell& cell, int corner) const;
  Vec3 corner(const FieldCell& cell, int corner) const {
    return cube.at(corner_place(cell, corner));
  }
};

/// Corners of a cell in the order in which Gmsh and VTK number the nodes of a hexahedron.
constexpr std::array<int, 8> hexahedron_corners = {0, 1, 3, 2, 4, 5, 7, 6};

enum class CellUse {
  /// The cells of the background grid; a grid is built aside if there is none. Exact ones are
  /// divided until interpolation between their corners shows what they answer.
  show,
  /// A grid built aside without exact cells, in a box a little larger than the model: interpolated
  /// between the corners of each cell, sizes keep the field's tolerance. Beside sources there are
  /// many times more cells.
  interpolate
};

/// The cells of the field of one entity or, without one, of the smallest size of all groups; those
/// outside the box of the group or model are left out. The field must be built. Throws Error if no
/// size function acts. Not thread-safe.
FieldCells field_cells(const SizeField& field, const std::optional<Entity>& entity, CellUse use);

/// The nodes of cells that share them. `sizes`: of several at one node, where cells of different
/// size meet, the smallest, so that no size becomes larger.
struct SharedNodes {
  std::vector<LatticePlace> places;
  std::vector<float> sizes;
  std::vector<std::array<std::uint32_t, 8>> of_cell;  ///< in the order of hexahedron_corners
};
SharedNodes shared_nodes(const FieldCells& cells);

}  // namespace meshgrow

#endif
