// A user's C++ program that is linked to a libgmsh of its own and meshes with meshgrow's C
// interface: one libmeshgrow serves it as it serves Python and the program.

#include <gmsh.h>

#include <cstdio>
#include <vector>

#include "meshgrow.h"

namespace {

int failures = 0;

void expect(bool condition, const char* what) {
  if (!condition) {
    std::printf("FAILED: %s (%s)\n", what, meshgrow_last_error());
    ++failures;
  }
}

}  // namespace

int main() {
  meshgrow_field* too_early = meshgrow_field_create();
  expect(too_early == nullptr, "no field before Gmsh is initialized");

  gmsh::initialize();
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::model::add("linked");
  gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1, 1);
  gmsh::model::occ::synchronize();

  meshgrow_field* field = meshgrow_field_create();
  expect(field != nullptr, "field of the current model");
  expect(meshgrow_field_add(field,
                            "fixed source Surface{1} attach Volume{1} size 0.05 growth 1.3 "
                            "limit 0.5") == 0,
         "fixed size function by text");
  const std::vector<double> points = {0, 0.5, 0.5, 1, 0.5, 0.5};
  std::vector<double> sizes(2);
  expect(meshgrow_field_size(field, 3, 1, points.data(), 2, sizes.data()) == 0, "sizes");
  expect(sizes[0] < 0.0526 && sizes[1] > 0.2 && sizes[1] < 0.3, "sizes grow from the surface");
  expect(meshgrow_field_generate(field, 3, 0) == 0, "generate");

  char* report = meshgrow_report_json(3, nullptr, 0, field);
  expect(report != nullptr, "report");
  if (report != nullptr) {
    std::printf("%s\n", report);
  }
  meshgrow_free(report);
  meshgrow_field_destroy(field);
  gmsh::finalize();
  if (failures == 0) {
    std::printf("linked program: all good with meshgrow %s\n", meshgrow_version());
  }
  return failures;
}
