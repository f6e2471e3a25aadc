// How a ModelField meshes the model, and suits itself to Gmsh's meshers.

#include <algorithm>

#include "error.h"
#include "gmsh_api.h"
#include "gmsh_state.h"
#include "model_field.h"
#include "ordered_mesher.h"
#include "remesh.h"
#include "stop_watch.h"

namespace meshgrow {

double ModelField::sizes_per_tetrahedron() {
  // Measured on both generations (DESIGN.md, section 5).
  switch (static_cast<int>(gmsh::option("Mesh.Algorithm3D"))) {
    case 1:  // Delaunay
      return 0.2;
    case 4:  // Frontal
      return 0.0;
    case 10:  // HXT
      return 2.0;
    default:
      return 0.5;
  }
}

void ModelField::adapt_to_meshers() {
  const auto algorithm_2d = static_cast<int>(gmsh::option("Mesh.Algorithm"));
  const auto algorithm_3d = static_cast<int>(gmsh::option("Mesh.Algorithm3D"));
  if (calibrate_) {
    answers_.calibrate(std::array<int, 4>{0, 0, algorithm_2d, algorithm_3d});
  } else {
    answers_.calibrate(std::nullopt);
  }
  const auto attached_dim = [this](int dim) {
    return std::any_of(
        field_.functions().begin(), field_.functions().end(),
        [dim](const SizeFunction& f) { return highest_dimension(f.attachments) >= dim; });
  };
  if (algorithm_2d == 7 && attached_dim(1)) {
    gmsh::log(
        "Mesh.Algorithm is 7 (BAMG), which asks for no sizes: the size functions do not act on "
        "curves and surfaces; choose 6 (Frontal-Delaunay) or 5 (Delaunay).",
        "warning");
  }
  if (algorithm_3d == 4 && attached_dim(3)) {
    gmsh::log(
        "Mesh.Algorithm3D is 4 (Frontal), which hardly asks for sizes: the size functions do not "
        "act inside volumes; choose 1 (Delaunay) or 10 (HXT).",
        "warning");
  }
}

std::vector<MeshingPass> ModelField::plan(int dim) const {
  check_changeable("plan passes");
  const CurrentModel current(model_);
  check_model();
  std::set<Entity> meshed;
  for (const Entity& entity : field_.topology().entities()) {
    if (gmsh::has_elements(entity)) {
      meshed.insert(entity);
    }
  }
  return OrderedMesher::plan(field_, std::move(meshed), dim);
}

void ModelField::generate(int dim, bool remesh) {
  check_changeable("mesh");
  if (generating_) {
    throw Error("This size field is meshing already: wait for its end.");
  }
  const CurrentModel current(model_);
  check_model();
  check_places();
  generating_ = true;
  forget_kept_sources();
  late_.clear();
  const bool was_registered = is_registered();
  unregister_callback();
  const auto register_again = [&] {
    generating_ = false;
    if (was_registered) {
      try {
        expect_late_sources(true);
      } catch (...) {
        late_.clear();  // sources are those that were read last
      }
      set_reader();
      ready_for_calls_ = true;
      callback_ = std::make_unique<SizeCallback>(answers_, model_);
    }
  };
  run_times_ = {};
  const StopWatch watch;
  try {
    adapt_to_meshers();
    OrderedMesher::check_options();
    if (remesh) {
      // Before anything is cleared: are there passes that do it?
      const std::set<Entity> kept = kept_when_meshing_again(field_);
      OrderedMesher::plan(field_, kept, dim);
      clear_all_but(kept, field_);
    }
    OrderedMesher(*this).generate(dim);
  } catch (...) {
    register_again();
    throw;
  }
  register_again();
  const double element_order = gmsh::option("Mesh.ElementOrder");
  if (element_order > 1.0) {
    GmshState state;
    state.set_option("Mesh.Renumber", 0.0);
    const StopWatch of_order;
    gmsh::set_order(static_cast<int>(element_order));
    run_times_.gmsh += of_order.seconds();
  }
  run_times_.meshgrow = watch.seconds() - run_times_.gmsh;
}

}  // namespace meshgrow
