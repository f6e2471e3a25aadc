// A crack: an inclined ellipse inside a block, finely meshed first; the volume grows from it.
//
//     crack crack.msh
//
// As crack.geo and crack.py, which explains it. Lengths are in millimetres.

#ifdef GMSH_OVER_C  // the newest from PyPI: its C++ functions may be of another C++ ABI
#include <gmsh.h_cwrap>
#else
#include <gmsh.h>
#endif

#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <meshgrow.hpp>
#include <string>

namespace {

/// Reads how much coarser to mesh; tests ask for it.
double coarse() {
  const char* const text = std::getenv("MESHGROW_EXAMPLES_COARSE");
  return text != nullptr ? std::stod(text) : 1;
}

constexpr double side = 100;               // of the block
constexpr double length = 50, width = 30;  // of the ellipse
const double tilt = std::acos(-1.0) / 4;   // against the horizontal
const double front_size = 0.5 * coarse();
const double crack_growth = 1.3, crack_limit = 3 * coarse();
const double block_growth = 1.2, block_limit = 12 * coarse();

struct CrackedBlock {
  meshgrow::DimTags block, crack, front;
};

CrackedBlock build_geometry() {
  namespace occ = gmsh::model::occ;
  const int block = occ::addBox(-side / 2, -side / 2, -side / 2, side, side, side);
  const int crack = occ::addDisk(0, 0, 0, length / 2, width / 2);
  occ::rotate({{2, crack}}, 0, 0, 0, 1, 0, 0, tilt);
  occ::synchronize();
  gmsh::model::mesh::embed(2, {crack}, 3, block);
  CrackedBlock model{{{3, block}}, {{2, crack}}, {}};
  gmsh::model::getBoundary(model.crack, model.front, true, false);
  return model;
}

void add_crack_sizes(meshgrow::SizeField& field, const CrackedBlock& model) {
  field.add_fixed(model.front, model.crack, front_size, crack_growth, crack_limit);
}

void add_block_sizes(meshgrow::SizeField& field, const CrackedBlock& model) {
  field.add_mesh(model.crack, model.block, block_growth, block_limit);
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string output = argc > 1 ? argv[1] : "crack.msh";
  gmsh::initialize();
  gmsh::option::setNumber("General.Verbosity", 2);
  gmsh::model::add("crack");
  gmsh::option::setNumber("Mesh.MeshSizeMax", block_limit);
  const CrackedBlock model = build_geometry();

  meshgrow::SizeField field;
  add_crack_sizes(field, model);
  add_block_sizes(field, model);
  field.generate(3);
  gmsh::option::setNumber("Mesh.SaveAll", 1);
  gmsh::write(output);

  std::cout << meshgrow::report_table({{"block", meshgrow::report(3, model.block, field)}});
  gmsh::finalize();
  return 0;
} catch (const std::exception& error) {
  std::cerr << "error: " << error.what() << '\n';
  return 1;
}
