#include "probe_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "gmsh_api.h"
#include "model_reader.h"
#include "number_text.h"
#include "size_function_text.h"

namespace meshgrow {

namespace {

using nlohmann::json;

json number_or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json numbers(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

json dim_tag(const Entity& entity) { return {entity.dim, entity.tag}; }

const char* rule_name(Rule rule) {
  switch (rule) {
    case Rule::facet:
      return "facet";
    case Rule::limit:
      return "limit";
    case Rule::inside_source:
      return "inside source";
    default:
      return "nothing";
  }
}

json facet_json(const SizeField& field, const Probe& probe, bool in_model) {
  json corners = json::array();
  for (int i = 0; i < probe.facet.facet.corner_count; ++i) {
    corners.push_back(numbers(probe.facet.facet.corners[i]));
  }
  json result = {{"entity", nullptr},
                 {"element", nullptr},
                 {"corners", corners},
                 {"start_size", probe.facet.start_size},
                 {"growth_rate", field.functions()[probe.function].growth_rate},
                 {"slope", probe.facet.slope},
                 {"distance", probe.distance}};
  if (probe.source) {
    result["entity"] = dim_tag(*probe.source);
    if (in_model) {
      if (const auto element = element_of_facet(*probe.source, probe.facet.facet)) {
        result["element"] = *element;
      }
    }
  }
  return result;
}

std::string point_text(const json& point) {
  std::string text;
  for (const json& coordinate : point) {
    text += (text.empty() ? "" : ", ") + shortest(coordinate.get<double>());
  }
  return text;
}

std::string name_of(const json& entity) {
  return entity_name({entity.at(0).get<int>(), entity.at(1).get<int>()});
}

std::string facet_text(const json& facet) {
  static const char* const shapes[] = {"a point", "a segment", "a triangle"};
  std::string text;
  if (facet.at("element").is_null()) {
    text = shapes[std::clamp<std::size_t>(facet.at("corners").size(), 1, 3) - 1];
  } else {
    text = "element " + std::to_string(facet.at("element").get<std::size_t>());
  }
  if (!facet.at("entity").is_null()) {
    text += " of " + name_of(facet.at("entity"));
  }
  return text;
}

std::string reason(const json& probe) {
  const std::string function =
      probe.at("function").is_null() ? "" : probe.at("function").at("title").get<std::string>();
  const std::string rule = probe.at("rule");
  if (rule == "facet") {
    const json& facet = probe.at("facet");
    const auto value = [&facet](const char* key) { return shortest(facet.at(key).get<double>()); };
    std::string corners;
    for (const json& corner : facet.at("corners")) {
      corners += (corners.empty() ? "(" : ", (") + point_text(corner) + ")";
    }
    return "from " + facet_text(facet) + " by " + function + ": " + value("start_size") +
           " there, growing by the rate " + value("growth_rate") + " over a distance of " +
           value("distance") + "\n  its corners: " + corners;
  }
  if (rule == "limit") {
    return "the size limit of " + function + "; nothing closer asks for less";
  }
  if (rule == "inside source") {
    return "the size of " + function + ", inside its source";
  }
  return "no size function acts here";
}

}  // namespace

std::optional<std::size_t> element_of_facet(const Entity& entity, const Facet& facet) {
  if (entity.dim < 1 || entity.dim > 2 || !gmsh::has_elements(entity)) {
    return std::nullopt;
  }
  const NodeCoordinates nodes;
  for (const gmsh::Elements& block : gmsh::elements(entity)) {
    const gmsh::ElementType type = gmsh::element_type(block.type);
    const auto step = static_cast<std::size_t>(type.node_count);
    for (std::size_t i = 0; i < block.tags.size(); ++i) {
      const std::size_t* tags = &block.node_tags[i * step];
      const bool has_all = std::all_of(
          facet.corners.begin(), facet.corners.begin() + facet.corner_count, [&](const Vec3& c) {
            return std::any_of(tags, tags + type.corner_count,
                               [&](std::size_t tag) { return nodes.at(tag, entity) == c; });
          });
      if (has_all) {
        return block.tags[i];
      }
    }
  }
  return std::nullopt;
}

json probe_json(const SizeField& field, const Probe& probe, const Vec3& p, bool in_model) {
  json result = {{"entity", dim_tag(probe.entity)},
                 {"point", numbers(p)},
                 {"size", number_or_null(probe.size)},
                 {"exact_size", number_or_null(probe.exact_size)},
                 {"interpolated_size", number_or_null(probe.grid_size)},
                 {"rule", rule_name(probe.rule)},
                 {"function", nullptr},
                 {"facet", nullptr}};
  if (probe.rule != Rule::nothing) {
    const SizeFunction& function = field.functions()[probe.function];
    result["function"] = {{"index", probe.function},
                          {"name", function.name},
                          {"title", field.function_name(probe.function)},
                          {"kind", kind_name(function.kind)},
                          {"text", size_function_text(function)}};
  }
  if (probe.rule == Rule::facet) {
    result["facet"] = facet_json(field, probe, in_model);
  }
  return result;
}

std::string probe_text(const json& probe) {
  std::string text = point_text(probe.at("point")) + " on " + name_of(probe.at("entity")) + ": ";
  if (probe.at("rule") == "nothing") {
    return text + reason(probe) + "\n";
  }
  text += "size " + shortest(probe.at("size").get<double>()) + " (exact " +
          shortest(probe.at("exact_size").get<double>());
  text += probe.at("interpolated_size").is_null()
              ? ", no grid)"
              : ", from the grid " + shortest(probe.at("interpolated_size").get<double>()) + ")";
  return text + "\n  " + reason(probe) + "\n  " +
         probe.at("function").at("title").get<std::string>() + ": " +
         probe.at("function").at("text").get<std::string>() + "\n";
}

}  // namespace meshgrow
