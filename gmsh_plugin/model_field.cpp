#include "model_field.h"

#include <algorithm>

#include "error.h"
#include "field_file.h"
#include "gmsh_api.h"
#include "model_reader.h"
#include "size_function_text.h"

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
  all_or_nothing([&] {
    add(function);
    function.kind = Kind::proximity;
    function.between = GapsBetween::both;
    if (!gap_regions(function, topology).empty()) {
      add(std::move(function));
    }
  });
}

}  // namespace meshgrow
