#include "size_function.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <tuple>

#include "error.h"
#include "number_text.h"

namespace meshgrow {

namespace {

/// Sizes beyond this are what Gmsh takes for "no size".
constexpr double largest_size = 1e22;

void check_size(double value, const std::string& what, const std::string& name) {
  if (!(value > 0.0 && value <= largest_size)) {
    throw Error(name + ": the " + what + " is " + shortest(value) +
                ", but it must be a positive length in model units.");
  }
}

void check_number(double value, double low, double high, const std::string& what,
                  const std::string& allowed, const std::string& name) {
  if (!(value >= low && value <= high)) {
    throw Error(name + ": the " + what + " is " + shortest(value) + ", but it must be " + allowed +
                ".");
  }
}

void check_entities(const std::vector<Entity>& entities, int lowest_dim, int highest_dim,
                    const std::string& role, const std::string& name, const Topology& topology) {
  if (entities.empty()) {
    throw Error(name + " has no " + role + ": name at least one entity.");
  }
  for (const Entity& entity : entities) {
    if (entity.dim < lowest_dim || entity.dim > highest_dim) {
      throw Error(name + ": " + entity_name(entity) + " cannot be its " + role + ": give " +
                  dimension_name(lowest_dim) + " to " + dimension_name(highest_dim) + " entities.");
    }
    if (!topology.contains(entity)) {
      throw Error(name + ": its " + role + " " + entity_name(entity) +
                  " is not in the model: check dimension and tag.");
    }
  }
}

}  // namespace

std::string kind_name(Kind kind) {
  switch (kind) {
    case Kind::mesh:
      return "mesh";
    case Kind::fixed:
      return "fixed";
    case Kind::curvature:
      return "curvature";
    default:
      return "proximity";
  }
}

std::set<Entity> curvature_sources(const SizeFunction& function, const Topology& topology) {
  const bool has_volumes = !topology.entities(3).empty();
  std::set<Entity> result;
  for (const Entity& source : function.sources) {
    if (source.dim < 3) {
      result.insert(source);
    }
    if (source.dim == 3 || (source.dim == 2 && !has_volumes)) {
      for (const Entity& lower : topology.lower(source)) {
        if (lower.dim == source.dim - 1) {
          result.insert(lower);
        }
      }
    }
  }
  return result;
}

std::vector<GapRegion> gap_regions(const SizeFunction& function, const Topology& topology) {
  const auto is_volume = [](const Entity& entity) { return entity.dim == 3; };
  const auto is_curve = [](const Entity& entity) { return entity.dim == 1; };
  const auto& [attachments, sources] = std::tie(function.attachments, function.sources);
  GapsBetween between = function.between;
  if (between == GapsBetween::automatic) {
    between = std::any_of(attachments.begin(), attachments.end(), is_volume) &&
                      !std::all_of(sources.begin(), sources.end(), is_curve)
                  ? GapsBetween::faces
                  : GapsBetween::edges;
  }
  const std::set<Entity> below = topology.closure(sources);
  std::vector<GapRegion> regions;
  for (const Entity& region : topology.closure(attachments)) {
    const bool wanted = region.dim == 3   ? between != GapsBetween::edges
                        : region.dim == 2 ? between != GapsBetween::faces
                                          : false;
    GapRegion result{region, {}};
    for (const Entity& lower : wanted ? topology.lower(region) : std::vector<Entity>()) {
      if (lower.dim == region.dim - 1 && below.count(lower) > 0) {
        result.sources.insert(lower);
      }
    }
    if (!result.sources.empty()) {
      regions.push_back(std::move(result));
    }
  }
  return regions;
}

bool is_number_name(const std::string& name) {
  return !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
}

std::string function_name(const SizeFunction& function, std::size_t index) {
  std::string name = kind_name(function.kind);
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  const std::string own = function.name.empty()           ? std::to_string(index + 1)
                          : is_number_name(function.name) ? function.name
                                                          : '"' + function.name + '"';
  return name + " size function " + own;
}

void validate(const SizeFunction& function, const std::string& name, const Topology& topology) {
  if (!(function.growth_rate >= 1.0 && std::isfinite(function.growth_rate))) {
    throw Error(name + ": the growth rate is " + shortest(function.growth_rate) +
                ", but it must be 1 or more, for example 1.2.");
  }
  check_size(function.size_limit, "size limit", name);
  const bool is_mesh = function.kind == Kind::mesh;
  const bool is_fixed = function.kind == Kind::fixed;
  if (is_fixed) {
    check_size(function.start_size, "size", name);
  }
  check_entities(function.sources, is_fixed ? 0 : 1, is_mesh ? 2 : 3, "source", name, topology);
  check_entities(function.attachments, 1, 3, "attachment", name, topology);
  if (is_mesh) {
    for (const Entity& source : function.sources) {
      if (std::count(function.attachments.begin(), function.attachments.end(), source) > 0) {
        throw Error(name + ": " + entity_name(source) +
                    " is source and attachment at once: a mesh cannot grow from itself, so take "
                    "it out of one of the two.");
      }
    }
  }
  if (function.kind == Kind::curvature) {
    check_number(function.angle, 0.1, 180.0, "angle", "degrees from 0.1 to 180, for example 18",
                 name);
  }
  if (function.kind == Kind::proximity) {
    check_number(function.cells_per_gap, 0.1, 1000.0, "number of cells per gap",
                 "from 0.1 to 1000, for example 3", name);
    if (gap_regions(function, topology).empty()) {
      throw Error(name + ": none of its sources (" + entity_names(function.sources) +
                  ") bounds an attachment in which it measures gaps: attach the volumes that its "
                  "faces bound, or, for gaps between edges, the surfaces that its curves bound.");
    }
  }
  if (function.kind == Kind::curvature || function.kind == Kind::proximity) {
    check_number(function.min_size, 0.0, function.size_limit, "smallest size",
                 "from 0 to the size limit, in model units", name);
  }
}

}  // namespace meshgrow
