// A box in a box. The faces of the inner one are meshed first, finely at one corner; then the
// volume around it, once with sizes that grow from these faces and once with Gmsh's own sizes.

#include <gmsh.h>

#include <exception>
#include <iostream>
#include <meshgrow.hpp>
#include <string>
#include <vector>

namespace {

constexpr double growth_rate = 1.2;
constexpr double size_limit = 0.6;

struct BoxInBox {
  int outer = 0;            ///< tag of the volume around the inner box
  gmsh::vectorpair common;  ///< faces of the inner box
};

BoxInBox make_model() {
  gmsh::model::add("box in box");
  namespace occ = gmsh::model::occ;
  const int inner = occ::addBox(-0.5, -0.5, -0.5, 1, 1, 1);
  const int box = occ::addBox(-2, -2, -2, 4, 4, 4);
  gmsh::vectorpair pieces;
  std::vector<gmsh::vectorpair> pieces_of;
  occ::fragment({{3, box}}, {{3, inner}}, pieces, pieces_of);
  occ::synchronize();
  const std::pair<int, int> kept = pieces_of[1].front();
  BoxInBox model;
  for (const auto& piece : pieces_of[0]) {
    if (piece != kept) {
      model.outer = piece.second;
    }
  }
  gmsh::model::getBoundary({kept}, model.common, true, false, false);
  return model;
}

/// Meshes the faces of the inner box: 0.03 at its corner (0.5, 0.5, 0.5), 0.15 at the one opposite.
void mesh_common_faces(const BoxInBox& model) {
  const int field = gmsh::model::mesh::field::add("MathEval");
  gmsh::model::mesh::field::setString(field, "F", "0.03 + 0.04 * (1.5 - x - y - z)");
  gmsh::model::mesh::field::setAsBackgroundMesh(field);
  gmsh::vectorpair everything;
  gmsh::model::getEntities(everything);
  gmsh::model::setVisibility(everything, 0);
  gmsh::model::setVisibility(model.common, 1, true);
  gmsh::option::setNumber("Mesh.MeshOnlyVisible", 1);
  gmsh::model::mesh::generate(2);
  gmsh::option::setNumber("Mesh.MeshOnlyVisible", 0);
  gmsh::model::setVisibility(everything, 1);
  gmsh::model::mesh::field::remove(field);
}

meshgrow::SizeField field_of(const BoxInBox& model) {
  meshgrow::SizeField field;
  field.add_mesh(model.common, {{3, model.outer}}, growth_rate, size_limit);
  return field;
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string output = argc > 1 ? argv[1] : "box_in_box.msh";
  gmsh::initialize();
  gmsh::option::setNumber("General.Verbosity", 2);
  gmsh::option::setNumber("Mesh.MeshSizeMax", size_limit);
  const BoxInBox model = make_model();
  mesh_common_faces(model);

  meshgrow::SizeField field = field_of(model);
  std::cout << field.plan(3);
  field.generate(3);
  const meshgrow::DimTags outer = {{3, model.outer}};
  const meshgrow::Report grown = meshgrow::report(3, outer, field);
  gmsh::write(output);

  gmsh::model::mesh::clear(outer);  // and once more between the same faces
  gmsh::model::mesh::generate(3);
  const meshgrow::Report by_gmsh = meshgrow::report(3, outer, field);

  std::cout << meshgrow::report_table({{"outer, Gmsh's sizes", by_gmsh}, {"outer, grown", grown}});
  gmsh::finalize();
  if (!(grown.value("ratio_99") < by_gmsh.value("ratio_99"))) {
    std::cerr << "error: sizes did not grow more smoothly than Gmsh's own\n";
    return 1;
  }
  return 0;
} catch (const std::exception& error) {
  std::cerr << "error: " << error.what() << '\n';
  return 1;
}
