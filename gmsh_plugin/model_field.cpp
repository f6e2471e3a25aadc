#include "model_field.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <optional>

#include "error.h"
#include "field_file.h"
#include "geometry_sampler.h"
#include "gmsh_api.h"
#include "gmsh_state.h"
#include "mesh_fingerprint.h"
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

/// Whether a function takes the sizes of a source's mesh itself.
bool is_read_as_meshed(const SizeFunction& function, const Entity& source) {
  return function.kind == Kind::mesh && (source.dim == 1 || source.dim == 2);
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

ModelField::ModelField(const std::string& file)
    : field_(load_field(file)), answers_(field_), file_(file) {}

void ModelField::check_changeable(const std::string& what) const {
  if (!file_.empty()) {
    throw Error("The size field of " + file_ + " cannot " + what +
                ": make one of the model for that; this one can be asked, shown and registered.");
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
  const std::size_t index = field_.add(std::move(function));
  apply_change(index);
  return index;
}

void ModelField::keep_meshed_sources(std::size_t first_function) {
  try {
    const CurrentModel current(model_);
    for (std::size_t i = first_function; i < field_.functions().size(); ++i) {
      for (const Entity& source : field_.functions()[i].sources) {
        if (is_read_as_meshed(field_.functions()[i], source) && kept_.count(source) == 0 &&
            gmsh::has_elements(source) && !gmsh::is_discrete(source)) {
          kept_[source] =
              read_entity_mesh(source, NodeCoordinates(field_.topology().closure({source})));
        }
      }
    }
    is_keeping_ = true;
  } catch (const Error&) {
    // Whoever reads the sources in earnest tells what is wrong with them.
  }
}

void ModelField::forget_kept_sources() {
  kept_.clear();
  is_keeping_ = false;
}

std::size_t ModelField::add(const std::string& text) {
  return add(parse_size_function(text, field_.topology()));
}

void ModelField::modify(const std::string& name, const std::string& text) {
  check_changeable("be changed");
  const std::size_t index = field_.find(name);
  field_.modify(index, parse_size_function(text, field_.topology()));
  read_as_.erase(index);
  apply_change(index);
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
  field_.remove(index);
  read_as_ = without(read_as_, index);
  late_ = without(late_, index);
  reported_.clear();
  apply_change();
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

std::vector<FacetedSource> ModelField::read_meshed(std::size_t function,
                                                   const NodeCoordinates& nodes) const {
  std::vector<FacetedSource> result;
  for (const Entity& source : field_.functions()[function].sources) {
    if (source.dim != 1 && source.dim != 2) {
      continue;
    }
    if (gmsh::has_elements(source)) {
      result.push_back(read_entity_mesh(source, nodes));
    } else if (const auto kept = kept_.find(source); kept != kept_.end()) {
      result.push_back(kept->second);
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
  MeshFingerprints fingerprints;
  for (const std::size_t index : functions) {
    read_as_[index].clear();
    for (const Entity& entity : watched(index)) {
      read_as_[index][entity] = fingerprints.of(entity);
    }
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

std::set<Entity> ModelField::watched(std::size_t function) const {
  const SizeFunction& definition = field_.functions()[function];
  const Topology& topology = field_.topology();
  std::vector<Entity> made_from = definition.sources;
  if (definition.kind == Kind::curvature) {
    const std::set<Entity> sources = curvature_sources(definition, topology);
    made_from.assign(sources.begin(), sources.end());
  } else if (definition.kind == Kind::proximity) {
    made_from.clear();
    for (const GapRegion& gaps : gap_regions(definition, topology)) {
      made_from.push_back(gaps.region);
    }
  }
  const int highest_read = definition.kind == Kind::proximity ? highest(made_from) - 1 : 2;
  std::set<Entity> result;
  for (const Entity& entity : topology.closure(made_from)) {
    if (entity.dim >= 1 && entity.dim <= highest_read) {
      result.insert(entity);
    }
  }
  return result;
}

std::vector<std::size_t> ModelField::unread_functions() const {
  std::vector<std::size_t> unread;
  MeshFingerprints fingerprints;
  for (std::size_t i = 0; i < field_.functions().size(); ++i) {
    const auto read_as = read_as_.find(i);
    const bool is_mesh = field_.functions()[i].kind == Kind::mesh;
    // Other kinds do without a mesh: one that came later is no reason to read them again.
    if (read_as == read_as_.end() ||
        std::any_of(read_as->second.begin(), read_as->second.end(), [&](const auto& read) {
          return (is_mesh || read.second != 0) && fingerprints.of(read.first) != read.second;
        })) {
      unread.push_back(i);
    }
  }
  return unread;
}

std::vector<FacetedSource> ModelField::read_fixed(std::size_t function,
                                                  const NodeCoordinates& nodes) const {
  const SizeFunction& definition = field_.functions()[function];
  const Topology& topology = field_.topology();
  std::vector<FacetedSource> sources;
  for (const Entity& source : definition.sources) {
    // A volume stands for its faces, and for what is embedded in it.
    for (const Entity& part :
         source.dim == 3 ? topology.lower(source) : std::vector<Entity>{source}) {
      sources.push_back(part.dim > 0 && gmsh::has_elements(part)
                            ? read_entity_mesh(part, nodes)
                            : sample_geometry(part, topology, definition.start_size));
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
      if (!gmsh::has_elements(source) && kept_.count(source) == 0) {
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
  if (!file_.empty()) {
    return;  // it has all that it will ever have
  }
  const CurrentModel current(model_);
  forget_kept_sources();
  read_all(is_registered() || ready_for_calls_);
}

void ModelField::read_all(bool wait_for_meshes) {
  check_model();
  std::vector<std::size_t> all(field_.functions().size());
  std::iota(all.begin(), all.end(), 0U);
  read_sources(all);
  reported_.clear();
  expect_late_sources(wait_for_meshes);
  for (const std::size_t function : all) {
    const auto late = late_.find(function);
    if (late == late_.end() || !late->second.waits_for_meshes) {
      report_unmeshed(function);
    }
  }
  field_.build({}, wait_for_meshes ? sizes_per_tetrahedron() : 0.0);
}

void ModelField::expect_late_sources(bool wait_for_meshes) {
  late_.clear();
  if (!wait_for_meshes) {
    return;
  }
  std::optional<NodeCoordinates> nodes;
  for (std::size_t i = 0; i < field_.functions().size(); ++i) {
    const SizeFunction& function = field_.functions()[i];
    const int before = highest(function.attachments);
    if (function.kind != Kind::mesh ||
        std::none_of(function.sources.begin(), function.sources.end(),
                     [before](const Entity& source) { return source.dim < before; })) {
      continue;
    }
    if (!nodes) {
      nodes.emplace();
    }
    const std::vector<Entity> unmeshed = unmeshed_sources(i);
    const auto was_read = read_as_.find(i);
    LateSources& late = late_[i];
    late.before = read_meshed(i, *nodes);
    for (const Entity& source : unmeshed) {
      const bool is_lost = was_read != read_as_.end() && was_read->second.at(source) != 0;
      late.has_lost |= is_lost;
      late.waits_for_meshes |= !strict_ && !is_lost && source.dim < before;
    }
  }
}

void ModelField::read_if_needed() {
  if (!file_.empty()) {
    return;
  }
  const CurrentModel current(model_);
  if (gmsh::option("Mesh.MeshSizeFactor") != size_factor_ && !read_as_.empty()) {
    refresh();
    return;
  }
  // Within a run of Gmsh, which has thrown meshes away, a user's own callback may ask.
  const bool may_run = is_registered() || ready_for_calls_;
  const std::vector<std::size_t> unread = may_run ? unread_within_run() : unread_functions();
  if (unread.empty()) {
    return;
  }
  check_model();
  forget_kept_sources();
  read_sources(unread);
  for (const std::size_t function : unread) {
    reported_.erase(function);
    report_unmeshed(function);
  }
  field_.build();
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
  if (!file_.empty()) {
    model_ = gmsh::current_model();
    check_acted_on();
  }
  const CurrentModel current(model_);
  SizeCallback::check_free_for(model_);
  if (file_.empty()) {
    forget_kept_sources();
    read_all(true);
    set_reader();
  }
  adapt_to_meshers();
  ready_for_calls_ = true;
  callback_.reset();
  callback_ = std::make_unique<SizeCallback>(answers_, model_);
}

void ModelField::check_acted_on() const {
  gmsh::require_gmsh();
  const std::vector<Entity> in_model = gmsh::entities();
  for (const Entity& entity : field_.topology().entities()) {
    if (field_.acts_on(entity) &&
        std::find(in_model.begin(), in_model.end(), entity) == in_model.end()) {
      throw Error("The size field of " + file_ + " acts on " + entity_name(entity) +
                  ", which is not in the model \"" + model_ +
                  "\": open the model it was made for.");
    }
  }
}

void ModelField::set_reader() {
  answers_.set_reader([this](int dim) { read_late_sources(dim); },
                      [](const Entity& curve) { return gmsh::has_elements(curve); });
}

void ModelField::unregister_callback() {
  callback_.reset();
  answers_.set_reader(nullptr, nullptr);
  ready_for_calls_ = false;
}

std::vector<std::size_t> ModelField::unread_within_run() const {
  std::vector<std::size_t> unread;
  MeshFingerprints fingerprints;
  for (std::size_t i = 0; i < field_.functions().size(); ++i) {
    const auto read_as = read_as_.find(i);
    bool is_unread = read_as == read_as_.end();
    bool is_lost = false;
    for (const auto& [entity, before] :
         is_unread ? std::map<Entity, std::uint64_t>() : read_as->second) {
      const std::uint64_t now = fingerprints.of(entity);
      const bool counts = before != 0 || field_.functions()[i].kind == Kind::mesh;
      is_unread |= counts && now != 0 && now != before;
      is_lost |= counts && now == 0 && before != 0;
    }
    if (is_unread && !is_lost) {
      unread.push_back(i);
    }
  }
  return unread;
}

void ModelField::make_ready_for_calls() {
  if (!file_.empty()) {
    model_ = gmsh::current_model();
    check_acted_on();
    adapt_to_meshers();
    return;
  }
  check_model();
  const std::vector<std::size_t> unread = unread_within_run();
  read_sources(unread);
  expect_late_sources(true);
  forget_kept_sources();
  for (const std::size_t function : unread) {
    const auto late = late_.find(function);
    if (late == late_.end() || !late->second.waits_for_meshes) {
      reported_.erase(function);
      report_unmeshed(function);
    }
  }
  field_.build({}, sizes_per_tetrahedron());
  adapt_to_meshers();
  set_reader();
}

void ModelField::try_to_make_ready_for_calls() {
  const std::lock_guard<std::mutex> lock(calls_mutex_);
  if (ready_for_calls_) {
    return;
  }
  std::string problem;
  try {
    make_ready_for_calls();
  } catch (const std::exception& error) {
    problem = error.what();
  }
  ready_for_calls_ = true;
  if (!problem.empty()) {
    gmsh::log("The size field cannot answer: " + problem, "warning");
  }
}

double ModelField::answer_call(int dim, int tag, double x, double y, double z,
                               double proposed) noexcept {
  try {
    if (file_.empty() && gmsh::current_model() != model_) {
      return proposed;
    }
    if (!ready_for_calls_ && !generating_) {
      try_to_make_ready_for_calls();
    }
  } catch (...) {
    if (file_.empty()) {  // a saved field can do without Gmsh
      return proposed;
    }
  }
  return answers_.answer(dim, tag, x, y, z, proposed);
}

void ModelField::read_late_sources(int dim) {
  MeshFingerprints fingerprints;
  for (const auto& [function, late] : late_) {
    std::vector<FacetedSource> sources;
    bool is_complete = true;
    for (const Entity& source : field_.functions()[function].sources) {
      const auto before =
          std::find_if(late.before.begin(), late.before.end(),
                       [&source](const FacetedSource& one) { return one.entity == source; });
      // One of this dimension may be half meshed now; one that Gmsh took the mesh from before its
      // turn is as it was.
      const std::uint64_t now = source.dim < dim ? fingerprints.of(source) : 0;
      if (now != 0 && now != read_as_.at(function).at(source)) {
        sources.push_back(
            read_entity_mesh(source, NodeCoordinates(field_.topology().closure({source}))));
      } else if (before != late.before.end()) {
        sources.push_back(*before);
      } else {
        is_complete = false;
      }
    }
    if (late.has_lost && !is_complete) {
      continue;
    }
    set_sources(function, sources);
    if (late.waits_for_meshes && dim > highest(field_.functions()[function].sources)) {
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
    gmsh::set_order(static_cast<int>(element_order));
  }
}

}  // namespace meshgrow
