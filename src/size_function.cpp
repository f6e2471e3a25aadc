#include "size_function.h"

#include <algorithm>
#include <cctype>
#include <cmath>

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

std::string kind_name(Kind kind) { return kind == Kind::mesh ? "mesh" : "fixed"; }

std::string function_name(const SizeFunction& function, std::size_t index) {
  std::string name = kind_name(function.kind);
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name + " size function " + std::to_string(index + 1);
}

void validate(const SizeFunction& function, const std::string& name, const Topology& topology) {
  if (!(function.growth_rate >= 1.0 && std::isfinite(function.growth_rate))) {
    throw Error(name + ": the growth rate is " + shortest(function.growth_rate) +
                ", but it must be 1 or more, for example 1.2.");
  }
  check_size(function.size_limit, "size limit", name);
  const bool is_mesh = function.kind == Kind::mesh;
  if (!is_mesh) {
    check_size(function.start_size, "size", name);
  }
  check_entities(function.sources, is_mesh ? 1 : 0, is_mesh ? 2 : 3, "source", name, topology);
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
}

}  // namespace meshgrow
