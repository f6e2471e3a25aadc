// Refinement from an earlier run: the surface mesh stays, the volume is meshed anew.
//
//     earlier_run folder/later_run.msh [growth rate [size limit]]
//
// As the later run of earlier_run.py, which explains it and writes the two files that are read
// here, from the same folder.

#ifdef GMSH_OVER_C  // the newest from PyPI: its C++ functions may be of another C++ ABI
#include <gmsh.h_cwrap>
#else
#include <gmsh.h>
#endif

#include <exception>
#include <filesystem>
#include <iostream>
#include <meshgrow.hpp>
#include <string>

namespace {

/// Reads the CAD and its mesh back, and throws away the tetrahedra.
void open_study(const std::filesystem::path& folder) {
  gmsh::model::add("later run");
  gmsh::vectorpair imported;
  gmsh::model::occ::importShapes((folder / "earlier_run.brep").string(), imported);
  gmsh::model::occ::synchronize();
  gmsh::merge((folder / "earlier_run_study.msh").string());
  gmsh::vectorpair volumes;
  gmsh::model::getEntities(volumes, 3);
  gmsh::model::mesh::clear(volumes);
}

/// The mesh size function of a later run: from the whole surface into the volume.
meshgrow::SizeField make_later_field(double growth_rate, double size_limit) {
  meshgrow::DimTags surfaces, volumes;
  gmsh::model::getEntities(surfaces, 2);
  gmsh::model::getEntities(volumes, 3);
  meshgrow::SizeField field;
  field.add_mesh(surfaces, volumes, growth_rate, size_limit);
  return field;
}

}  // namespace

int main(int argc, char** argv) try {
  const std::filesystem::path output = argc > 1 ? argv[1] : "later_run.msh";
  gmsh::initialize();
  gmsh::option::setNumber("General.Verbosity", 2);
  open_study(output.parent_path());

  meshgrow::SizeField field =
      make_later_field(argc > 2 ? std::stod(argv[2]) : 1.5, argc > 3 ? std::stod(argv[3]) : 2.0);
  field.generate(3);
  gmsh::option::setNumber("Mesh.SaveAll", 1);
  gmsh::write(output.string());

  std::cout << meshgrow::report_table({{"volume", meshgrow::report(3, {}, field)}});
  gmsh::finalize();
  return 0;
} catch (const std::exception& error) {
  std::cerr << "error: " << error.what() << '\n';
  return 1;
}
