#include <algorithm>
#include <limits>

#include "binary_stream.h"
#include "error.h"
#include "field_files.h"

namespace meshgrow {

namespace {

/// Kinds of elements and texts that the format counts, and where scalar hexahedra stand.
constexpr int counts_in_header = 49;
constexpr int scalar_hexahedra = 15;

/// The format separates words by blanks, and its readers have room for 255 characters.
std::string as_word(std::string name) {
  name.resize(std::min<std::size_t>(name.size(), 255));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == '\t' || c == '\n'; }, '^');
  return name.empty() ? "sizes" : name;
}

}  // namespace

void write_pos(const FieldCells& cells, const std::string& name, std::ostream& file) {
  // Gmsh's reader counts doubles by an int.
  constexpr std::size_t doubles_a_cell = 32;
  if (cells.cells.size() > std::numeric_limits<int>::max() / doubles_a_cell) {
    throw Error("The size field has " + std::to_string(cells.cells.size()) +
                " cells, too many for a view of Gmsh: raise its tolerance.");
  }
  file << "$PostFormat\n1.4 1 " << sizeof(double) << "\n$EndPostFormat\n$View\n"
       << as_word(name) << " 1";
  for (int i = 0; i < counts_in_header; ++i) {
    file << ' ' << (i == scalar_hexahedra ? cells.cells.size() : 0);
  }
  file << '\n';
  write_binary(file, 1);    // tells the byte order
  write_binary(file, 0.0);  // time of the only step
  for (const FieldCell& cell : cells.cells) {
    std::array<Vec3, 8> corners;
    for (int i = 0; i < 8; ++i) {
      corners[i] = cells.corner(cell, hexahedron_corners[i]);
    }
    for (int axis = 0; axis < 3; ++axis) {
      for (const Vec3& corner : corners) {
        write_binary(file, corner[axis]);
      }
    }
    for (const int corner : hexahedron_corners) {
      write_binary(file, static_cast<double>(cell.sizes[corner]));
    }
  }
  file << "\n$EndView\n";
}

}  // namespace meshgrow
