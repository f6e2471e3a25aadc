#include "model_field.h"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <mutex>
#include <numeric>
#include <shared_mutex>
#include <system_error>

#include "error.h"
#include "field_file.h"
#include "gmsh_api.h"
#include "gmsh_state.h"
#include "model_reader.h"
#include "ordered_mesher.h"
#include "remesh.h"
#include "simd/refused_kernels.h"
#include "size_function_text.h"
#include "stop_watch.h"

namespace meshgrow {

namespace {

Topology topology_of_current_model() {
  gmsh::require_gmsh();
  return read_topology();
}

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
  warn_of_refused_kernels();
  model_ = gmsh::current_model();
  for (const Entity& point : field_.topology().entities(0)) {
    const std::vector<Vec3> places = gmsh::points_at(point, {});
    if (places.size() == 1 && !gmsh::is_discrete(point)) {
      points_[point] = places.front();
    }
  }
  field_.options().boundary = boundary_triangles;
  field_.options().progress = [this](const std::string& what, double done) {
    tell_grid(what, done);
  };
  field_.options().warn = [this](const std::string& sentence) { warn(sentence); };
}

ModelField::ModelField(const std::string& file)
    : field_(load_field(file)), answers_(field_), file_(file) {
  warn_of_refused_kernels();
  field_.options().warn = [this](const std::string& sentence) { warn(sentence); };
}

/// A field from a file may be used without any Gmsh.
void ModelField::warn(const std::string& sentence) const {
  try {
    gmsh::require_gmsh();
    gmsh::log(sentence, "warning");
  } catch (const Error&) {
    if (listener_) {
      listener_("Warning: " + sentence);
    } else {
      std::cerr << "meshgrow: " << sentence << std::endl;
    }
  }
}

/// Once for each process.
void ModelField::warn_of_refused_kernels() const {
  static const std::string refused = simd::refused_kernels();
  static bool has_warned = false;
  if (!refused.empty() && !has_warned) {
    has_warned = true;
    warn("MESHGROW_SIMD is \"" + refused +
         "\", which is nothing that this processor runs, and is ignored: set it to plain, avx2 or "
         "avx512, or unset it.");
  }
}

void ModelField::check_changeable(const std::string& what) const {
  if (!file_.empty()) {
    throw Error("The size field of " + file_ + " cannot " + what +
                ": make one of the model for that; this one can be asked, shown and registered.");
  }
}

void ModelField::all_or_nothing(const std::function<void()>& body) {
  SizeField field = field_;
  auto late = late_;
  auto read_as = read_as_;
  const double size_factor = size_factor_;
  const bool ready_for_calls = ready_for_calls_;
  try {
    body();
  } catch (...) {
    field_ = std::move(field);
    late_ = std::move(late);
    read_as_ = std::move(read_as);
    size_factor_ = size_factor;
    ready_for_calls_ = ready_for_calls;
    throw;
  }
}

void ModelField::apply_change(std::optional<std::size_t> function) {
  ready_for_calls_ = false;
  if (is_registered()) {
    refresh();
  } else if (function) {
    keep_meshed_sources(is_keeping_ ? *function : 0);
  }
}

void ModelField::stop_if_asked() const {
  if (wants_stop_ && wants_stop_()) {
    throw Error("Stopped as asked; what was meshed before is kept.");
  }
}

void ModelField::tell(const std::string& line) const {
  stop_if_asked();
  if (listener_) {
    listener_(line);
  } else {
    gmsh::log("Meshgrow: " + line);
  }
}

void ModelField::tell_grid(const std::string& what, double done) {
  stop_if_asked();
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
  check_changeable("be changed");
  std::size_t index = 0;
  all_or_nothing([&] {
    index = field_.add(std::move(function));
    apply_change(index);
  });
  return index;
}

std::size_t ModelField::add(const std::string& text) {
  return add(parse_size_function(text, field_.topology()));
}

void ModelField::modify(const std::string& name, const std::string& text) {
  check_changeable("be changed");
  const std::size_t index = field_.find(name);
  all_or_nothing([&] {
    field_.modify(index, parse_size_function(text, field_.topology()));
    read_as_.erase(index);
    apply_change(index);
  });
}

namespace {

/// Of values by index, without the one of this index.
template <typename Value>
std::map<std::size_t, Value> without(const std::map<std::size_t, Value>& values,
                                     std::size_t removed) {
  std::map<std::size_t, Value> result;
  for (const auto& [index, value] : values) {
    if (index != removed) {
      result.emplace(index > removed ? index - 1 : index, value);
    }
  }
  return result;
}

}  // namespace

void ModelField::remove(const std::string& name) {
  check_changeable("be changed");
  const std::size_t index = field_.find(name);
  all_or_nothing([&] {
    field_.remove(index);
    read_as_ = without(read_as_, index);
    late_ = without(late_, index);
    reported_.clear();
    apply_change();
  });
}

void ModelField::rename(const std::string& name, const std::string& new_name) {
  check_changeable("be changed");
  field_.rename(field_.find(name), new_name);
}

void ModelField::save(const std::string& file) {
  refresh_if_needed();
  field_.build_grids();
  save_field(field_, file);
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

void ModelField::check_places() const {
  for (const auto& [point, place] : points_) {
    if (gmsh::points_at(point, {}) != std::vector<Vec3>{place} && !gmsh::is_discrete(point)) {
      throw Error(entity_name(point) +
                  " is not where it was when this size field was made, so the model was built anew "
                  "or moved: make a new field after changing the geometry.");
    }
  }
}

void ModelField::change(const std::function<void()>& body) {
  std::unique_lock<std::shared_mutex> lock(answers_.mutex(), std::defer_lock);
  try {
    if (answers_.is_asking_user()) {
      throw std::system_error(std::make_error_code(std::errc::resource_deadlock_would_occur));
    }
    lock.lock();
  } catch (const std::system_error&) {
    throw Error(
        "The size field is at work, and called this: let your own sizes and the listener of "
        "progress not change it.");
  }
  body();
}

void ModelField::refresh() {
  if (file_.empty()) {  // else it has all that it will ever have
    change([this] { refresh_unlocked(); });
  }
}

void ModelField::refresh_unlocked() {
  const CurrentModel current(model_);
  all_or_nothing([this] { read_all(is_registered() || ready_for_calls_); });
}

void ModelField::read_all(bool wait_for_meshes) {
  check_model();
  check_places();
  forget_kept_sources();
  std::vector<std::size_t> all(field_.functions().size());
  std::iota(all.begin(), all.end(), 0U);
  read_sources(all);
  reported_.clear();
  expect_late_sources(wait_for_meshes);
  for (const std::size_t function : all) {
    if (!waits_for_meshes(function)) {
      report_unmeshed(function);
    }
  }
  field_.build({}, wait_for_meshes ? sizes_per_tetrahedron() : 0.0);
}

void ModelField::read_if_needed() {
  if (!file_.empty()) {
    return;
  }
  const CurrentModel current(model_);
  if (gmsh::option("Mesh.MeshSizeFactor") != size_factor_ && !read_as_.empty()) {
    refresh_unlocked();
    return;
  }
  // Within a run of Gmsh, which has thrown meshes away, a user's own callback may ask.
  const bool may_run = is_registered() || ready_for_calls_;
  if (!may_run) {
    check_model();
    for (std::size_t i = 0; strict_ && i < field_.functions().size(); ++i) {
      report_unmeshed(i);
    }
  }
  const std::vector<std::size_t> unread = unread_functions(may_run);
  if (unread.empty()) {
    return;
  }
  if (may_run) {
    check_model();
  }
  check_places();
  forget_kept_sources();
  all_or_nothing([&] {
    read_sources(unread);
    for (const std::size_t function : unread) {
      reported_.erase(function);
      report_unmeshed(function);
    }
    field_.build();
  });
}

void ModelField::ask(const std::function<void(const SizeField&)>& question) {
  if (answers_.is_asking_user()) {
    question(field_);
    return;
  }
  change([this] { refresh_if_needed(); });
  const std::shared_lock<std::shared_mutex> lock(answers_.mutex());
  question(field_);
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
