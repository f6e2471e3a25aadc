#include "model_field.h"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "error.h"
#include "geometry_sampler.h"
#include "gmsh_api.h"
#include "gmsh_state.h"
#include "model_reader.h"
#include "number_text.h"
#include "ordered_mesher.h"
#include "size_function_text.h"

namespace meshgrow {

namespace {

Topology topology_of_current_model() {
  gmsh::require_gmsh();
  return read_topology();
}

}  // namespace

ModelField::ModelField() : field_(topology_of_current_model()) {
  model_ = gmsh::current_model();
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

void ModelField::read_sources(const std::vector<std::size_t>& functions) {
  if (functions.empty()) {
    return;
  }
  const NodeCoordinates nodes;
  for (const std::size_t index : functions) {
    const SizeFunction& function = field_.functions()[index];
    std::vector<FacetedSource> sources;
    for (const Entity& source : function.sources) {
      const bool meshed = (source.dim == 1 || source.dim == 2) && gmsh::has_elements(source);
      if (meshed) {
        sources.push_back(read_entity_mesh(source, nodes));
      } else if (function.kind == Kind::fixed) {
        sources.push_back(sample_geometry(source, field_.topology(), function.start_size));
      }
    }
    const DroppedFacets dropped = field_.set_sources(index, sources);
    if (dropped.zero_size + dropped.not_finite > 0) {
      gmsh::log(field_.function_name(index) + ": " +
                    grouped_digits(dropped.zero_size + dropped.not_finite) +
                    " elements of its sources have no size or no finite coordinates and are left "
                    "out: check the mesh of " +
                    entity_names(function.sources) + ".",
                "warning");
    }
  }
}

void ModelField::report_unmeshed(std::size_t function) {
  if (field_.functions()[function].kind != Kind::mesh) {
    return;
  }
  std::vector<Entity> unmeshed;
  for (const Entity& source : field_.functions()[function].sources) {
    if (!gmsh::has_elements(source)) {
      unmeshed.push_back(source);
    }
  }
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
  std::sort(now.begin(), now.end());
  if (now != field_.topology().entities()) {
    throw Error(
        "The model has other entities than when this size field was made: make a new field "
        "after changing the geometry.");
  }
}

void ModelField::refresh() {
  const CurrentModel current(model_);
  check_model();
  std::vector<std::size_t> all(field_.functions().size());
  std::iota(all.begin(), all.end(), 0U);
  read_sources(all);
  reported_.clear();
  for (const std::size_t function : all) {
    report_unmeshed(function);
  }
  field_.build();
  sources_read_ = true;
}

void ModelField::refresh_if_needed() {
  if (!sources_read_) {
    refresh();
  } else {
    field_.build();
  }
}

void ModelField::register_callback() {
  refresh();
  const CurrentModel current(model_);
  callback_.reset();
  callback_ = std::make_unique<SizeCallback>(field_, model_);
}

void ModelField::generate(int dim) {
  if (generating_) {
    throw Error("This size field is meshing already: wait for its end.");
  }
  const CurrentModel current(model_);
  check_model();
  generating_ = true;
  const bool was_registered = is_registered();
  unregister_callback();
  const auto register_again = [&] {
    generating_ = false;
    if (was_registered) {
      callback_ = std::make_unique<SizeCallback>(field_, model_);
    }
  };
  try {
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
