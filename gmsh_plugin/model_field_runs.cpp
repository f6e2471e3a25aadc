// What a ModelField does while Gmsh meshes by itself: registered, or called as a size callback.

#include <algorithm>
#include <optional>

#include "error.h"
#include "gmsh_api.h"
#include "gmsh_state.h"
#include "mesh_fingerprint.h"
#include "model_field.h"
#include "model_reader.h"

namespace meshgrow {

void ModelField::register_callback() {
  if (!file_.empty()) {
    model_ = gmsh::current_model();
    check_acted_on();
  }
  const CurrentModel current(model_);
  SizeCallback::check_free_for(model_);
  if (file_.empty()) {
    all_or_nothing([this] { read_all(true); });
  }
  adapt_to_meshers();
  auto callback = std::make_unique<SizeCallback>(answers_, model_);
  if (file_.empty()) {
    set_reader();
  }
  ready_for_calls_ = true;
  callback_ = std::move(callback);
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

bool ModelField::waits_for_meshes(std::size_t function) const {
  const auto late = late_.find(function);
  return late != late_.end() && late->second.waits_for_meshes;
}

void ModelField::make_ready_for_calls() {
  if (!file_.empty()) {
    model_ = gmsh::current_model();
    check_acted_on();
    adapt_to_meshers();
    return;
  }
  check_model();
  check_places();
  const std::vector<std::size_t> unread = unread_functions(true);
  read_sources(unread);
  expect_late_sources(true);
  forget_kept_sources();
  for (const std::size_t function : unread) {
    if (!waits_for_meshes(function)) {
      reported_.erase(function);
      report_unmeshed(function);
    }
  }
  field_.build({}, sizes_per_tetrahedron());
  adapt_to_meshers();
  set_reader();
}

void ModelField::try_to_make_ready_for_calls() {
  change([this] {
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
  });
}

double ModelField::answer_call(int dim, int tag, double x, double y, double z,
                               double proposed) noexcept {
  try {
    if (file_.empty() && gmsh::current_model() != model_) {
      tell_of_other_model();
      return proposed;
    }
    if (!ready_for_calls_ && !generating_ && !answers_.is_asking_user()) {
      try_to_make_ready_for_calls();
    }
  } catch (...) {
    if (file_.empty()) {  // a saved field can do without Gmsh
      return proposed;
    }
  }
  return answers_.answer(dim, tag, x, y, z, proposed);
}

/// Once: a run asks a million times.
void ModelField::tell_of_other_model() {
  if (!told_of_other_model_.exchange(true)) {
    gmsh::log("The size field of model \"" + model_ + "\" is asked for sizes of model \"" +
                  gmsh::current_model() +
                  "\" and has none for it: give that model a field of its own.",
              "warning");
  }
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
    if (late.waits_for_meshes && dim > highest_dimension(field_.functions()[function].sources)) {
      report_unmeshed(function);
    }
  }
  field_.build_trees();
}

void ModelField::expect_late_sources(bool wait_for_meshes) {
  late_.clear();
  if (!wait_for_meshes) {
    return;
  }
  std::optional<NodeCoordinates> nodes;
  for (std::size_t i = 0; i < field_.functions().size(); ++i) {
    const SizeFunction& function = field_.functions()[i];
    const int before = highest_dimension(function.attachments);
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

}  // namespace meshgrow
