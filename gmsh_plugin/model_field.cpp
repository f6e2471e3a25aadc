#include "model_field.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <optional>

#include "error.h"
#include "geometry_sampler.h"
#include "gmsh_api.h"
#include "gmsh_state.h"
#include "model_reader.h"
#include "number_text.h"
#include "ordered_mesher.h"
#include "remesh.h"
#include "size_function_text.h"

namespace meshgrow {

namespace {

Topology topology_of_current_model() {
  gmsh::require_gmsh();
  return read_topology();
}

int highest(const std::vector<Entity>& entities) {
  return std::max_element(entities.begin(), entities.end())->dim;
}

}  // namespace

namespace {

/// See FieldOptions::boundary.
std::vector<std::array<Vec3, 3>> boundary_triangles(const std::vector<Entity>& volumes) {
  std::vector<std::array<Vec3, 3>> triangles;
  const NodeCoordinates nodes;
  for (const Entity& volume : volumes) {
    for (const Entity& face : gmsh::boundary(volume)) {
      const FacetedSource mesh = read_entity_mesh(face, nodes);
      if (mesh.triangles.empty() && mesh.quads.empty()) {
        return {};
      }
      triangles.insert(triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
      for (const auto& [a, b, c, d] : mesh.quads) {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
      }
    }
  }
  return triangles;
}

}  // namespace

ModelField::ModelField() : field_(topology_of_current_model()), answers_(field_) {
  model_ = gmsh::current_model();
  field_.options().boundary = boundary_triangles;
  field_.options().progress = [this](const std::string& what, double done) {
    tell_grid(what, done);
  };
}

void ModelField::tell(const std::string& line) const {
  if (listener_) {
    listener_(line);
  } else {
    gmsh::log("Meshgrow: " + line);
  }
}

void ModelField::tell_grid(const std::string& what, double done) {
  const auto now = std::chrono::steady_clock::now();
  if (what != grid_told_of_) {
    grid_told_of_ = what;
    grid_told_at_ = now;
  }
  if (done == 1.0) {
    tell(what + ": done");
    grid_told_of_.clear();
  } else if (now - grid_told_at_ > std::chrono::seconds(1)) {
    tell(what + ": " + std::to_string(static_cast<int>(100.0 * done)) + " %");
    grid_told_at_ = now;
  }
}

std::size_t ModelField::add(SizeFunction function) {
  sources_read_ = false;
  return field_.add(std::move(function));
}

std::size_t ModelField::add(const std::string& text) {
  return add(parse_size_function(text, field_.topology()));
}

void ModelField::create_defaults(std::vector<Entity> attachments, double growth_rate,
                                 double size_limit, double min_size) {
  const Topology& topology = field_.topology();
  for (int dim = 3; dim > 0 && attachments.empty(); --dim) {
    attachments = topology.entities(dim);
  }
  SizeFunction function;
  function.kind = Kind::curvature;
  function.sources = attachments;
  function.attachments = std::move(attachments);
  function.growth_rate = growth_rate;
  function.size_limit = size_limit;
  function.min_size = min_size;
  add(function);
  function.kind = Kind::proximity;
  function.between = GapsBetween::both;
  if (!gap_regions(function, topology).empty()) {
    add(std::move(function));
  }
}

std::vector<FacetedSource> ModelField::read_meshed(std::size_t function,
                                                   const NodeCoordinates& nodes) const {
  std::vector<FacetedSource> result;
  for (const Entity& source : field_.functions()[function].sources) {
    if ((source.dim == 1 || source.dim == 2) && gmsh::has_elements(source)) {
      result.push_back(read_entity_mesh(source, nodes));
    }
  }
  return result;
}

void ModelField::set_sources(std::size_t function, const std::vector<FacetedSource>& sources) {
  const DroppedFacets dropped = field_.set_sources(function, sources, size_factor_);
  if (dropped.zero_size + dropped.not_finite > 0) {
    gmsh::log(field_.function_name(function) + ": " +
                  grouped_digits(dropped.zero_size + dropped.not_finite) +
                  " elements of its sources have no size or no finite coordinates and are left "
                  "out: check the mesh of " +
                  entity_names(field_.functions()[function].sources) + ".",
              "warning");
  }
}

void ModelField::read_sources(const std::vector<std::size_t>& functions) {
  if (functions.empty()) {
    return;
  }
  size_factor_ = gmsh::option("Mesh.MeshSizeFactor");
  const NodeCoordinates nodes;
  SourceFacets facets(field_.topology(), nodes);
  for (const std::size_t index : functions) {
    switch (field_.functions()[index].kind) {
      case Kind::mesh:
        set_sources(index, read_meshed(index, nodes));
        break;
      case Kind::fixed:
        set_sources(index, read_fixed(index, nodes));
        break;
      case Kind::curvature:
        read_curvature(index, facets);
        break;
      case Kind::proximity:
        read_proximity(index, facets);
        break;
    }
  }
}

std::vector<FacetedSource> ModelField::read_fixed(std::size_t function,
                                                  const NodeCoordinates& nodes) const {
  const SizeFunction& definition = field_.functions()[function];
  std::vector<FacetedSource> sources = read_meshed(function, nodes);
  for (const Entity& source : definition.sources) {
    if (std::none_of(sources.begin(), sources.end(),
                     [&source](const FacetedSource& read) { return read.entity == source; })) {
      sources.push_back(sample_geometry(source, field_.topology(), definition.start_size));
    }
  }
  return sources;
}

void ModelField::read_curvature(std::size_t function, SourceFacets& facets) {
  const SizeFunction& definition = field_.functions()[function];
  std::vector<FacetedSource> sources;
  for (const Entity& source : curvature_sources(definition, field_.topology())) {
    sources.push_back(facets.with_curvature(source, definition));
  }
  set_sources(function, sources);
}

void ModelField::read_proximity(std::size_t function, SourceFacets& facets) {
  std::vector<WalledRegion> regions;
  for (GapRegion& gaps : gap_regions(field_.functions()[function], field_.topology())) {
    std::vector<Wall> walls = facets.walls(gaps.region);
    regions.push_back({std::move(gaps), std::move(walls)});
  }
  field_.set_regions(function, regions);
}

std::vector<Entity> ModelField::unmeshed_sources(std::size_t function) const {
  std::vector<Entity> unmeshed;
  if (field_.functions()[function].kind == Kind::mesh) {
    for (const Entity& source : field_.functions()[function].sources) {
      if (!gmsh::has_elements(source)) {
        unmeshed.push_back(source);
      }
    }
  }
  return unmeshed;
}

void ModelField::report_unmeshed(std::size_t function) {
  const std::vector<Entity> unmeshed = unmeshed_sources(function);
  if (unmeshed.empty()) {
    return;
  }
  const std::string sentence = field_.function_name(function) + ": " + entity_names(unmeshed) +
                               (unmeshed.size() == 1 ? " has no mesh" : " have no mesh") +
                               (field_.is_effective(function) ? ", so only its other sources act"
                                                              : ", so the function has no effect") +
                               ": mesh the source before what grows from it.";
  if (strict_) {
    throw Error(sentence);
  }
  if (reported_.insert(function).second) {
    gmsh::log(sentence, "warning");
  }
}

void ModelField::check_model() const {
  std::vector<Entity> now = gmsh::entities();
  now.erase(std::remove_if(now.begin(), now.end(),
                           [this](const Entity& entity) {
                             return !field_.topology().contains(entity) &&
                                    field_.topology().contains(
                                        {entity.dim, entity.tag - gmsh::compound_offset});
                           }),
            now.end());
  std::sort(now.begin(), now.end());
  if (now != field_.topology().entities()) {
    throw Error(
        "The model has other entities than when this size field was made: make a new field "
        "after changing the geometry.");
  }
}

void ModelField::refresh() {
  const CurrentModel current(model_);
  read_all(is_registered());
}

void ModelField::read_all(bool wait_for_meshes) {
  check_model();
  std::vector<std::size_t> all(field_.functions().size());
  std::iota(all.begin(), all.end(), 0U);
  read_sources(all);
  reported_.clear();
  late_.clear();
  std::optional<NodeCoordinates> nodes;
  for (const std::size_t function : all) {
    const std::vector<Entity> unmeshed = unmeshed_sources(function);
    if (wait_for_meshes && !strict_ && !unmeshed.empty() &&
        std::min_element(unmeshed.begin(), unmeshed.end())->dim <
            highest(field_.functions()[function].attachments)) {
      if (!nodes) {
        nodes.emplace();
      }
      late_[function] = read_meshed(function, *nodes);
    } else {
      report_unmeshed(function);
    }
  }
  field_.build({}, wait_for_meshes ? sizes_per_tetrahedron() : 0.0);
  sources_read_ = true;
}

void ModelField::read_if_needed() {
  if (!sources_read_ || gmsh::option("Mesh.MeshSizeFactor") != size_factor_) {
    refresh();
  }
}

void ModelField::refresh_if_needed() {
  read_if_needed();
  field_.build();
}

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

void ModelField::register_callback() {
  const CurrentModel current(model_);
  SizeCallback::check_free_for(model_);
  read_all(true);
  adapt_to_meshers();
  set_reader();
  callback_.reset();
  callback_ = std::make_unique<SizeCallback>(answers_, model_);
}

void ModelField::set_reader() {
  answers_.set_reader([this](int dim) { read_late_sources(dim); },
                      [](const Entity& curve) { return gmsh::has_elements(curve); });
}

void ModelField::unregister_callback() {
  callback_.reset();
  answers_.set_reader(nullptr, nullptr);
}

void ModelField::read_late_sources(int dim) {
  for (const auto& [function, meshed_before] : late_) {
    std::vector<FacetedSource> sources = meshed_before;
    for (const Entity& source : field_.functions()[function].sources) {
      const bool known =
          std::any_of(meshed_before.begin(), meshed_before.end(),
                      [&source](const FacetedSource& before) { return before.entity == source; });
      // One of this dimension may be half meshed now.
      if (!known && source.dim < dim && gmsh::has_elements(source)) {
        sources.push_back(
            read_entity_mesh(source, NodeCoordinates(field_.topology().closure({source}))));
      }
    }
    set_sources(function, sources);
    if (dim > highest(field_.functions()[function].sources)) {
      report_unmeshed(function);
    }
  }
  field_.build_trees();
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
    return std::any_of(field_.functions().begin(), field_.functions().end(),
                       [dim](const SizeFunction& f) { return highest(f.attachments) >= dim; });
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
  if (generating_) {
    throw Error("This size field is meshing already: wait for its end.");
  }
  const CurrentModel current(model_);
  check_model();
  generating_ = true;
  std::map<std::size_t, std::vector<FacetedSource>> late = std::move(late_);
  late_.clear();
  const bool was_registered = is_registered();
  unregister_callback();
  const auto register_again = [&] {
    generating_ = false;
    if (was_registered) {
      late_ = std::move(late);
      set_reader();
      callback_ = std::make_unique<SizeCallback>(answers_, model_);
    }
  };
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
  sources_read_ = true;
  const double element_order = gmsh::option("Mesh.ElementOrder");
  if (element_order > 1.0) {
    GmshState state;
    state.set_option("Mesh.Renumber", 0.0);
    gmsh::set_order(static_cast<int>(element_order));
  }
}

}  // namespace meshgrow
