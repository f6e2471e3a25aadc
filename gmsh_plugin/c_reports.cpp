// The C interface: reports of meshes.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "c_guard.h"
#include "error.h"
#include "gmsh_api.h"
#include "json_text.h"
#include "mesh_report.h"
#include "meshgrow.h"
#include "model_reader.h"
#include "worst_places.h"

namespace {

using meshgrow::Entity;
using meshgrow::Error;
using namespace meshgrow::c;
using nlohmann::json;

/// JSON has no word for "not a number": null stands for it.
json number_or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

double number_or_unknown(const json& value) {
  return value.is_number() ? value.get<double>() : meshgrow::MeshReport::unknown;
}

struct ReportKey {
  const char* name;
  double meshgrow::MeshReport::*value;
};

constexpr ReportKey report_keys[] = {
    {"smallest_size", &meshgrow::MeshReport::smallest_size},
    {"largest_size", &meshgrow::MeshReport::largest_size},
    {"ratio_max", &meshgrow::MeshReport::ratio_max},
    {"ratio_99", &meshgrow::MeshReport::ratio_99},
    {"length_median", &meshgrow::MeshReport::length_median},
    {"length_share_good", &meshgrow::MeshReport::length_share_good},
    {"length_share_over_2", &meshgrow::MeshReport::length_share_over_2},
    {"gamma_min", &meshgrow::MeshReport::gamma_min},
    {"gamma_mean", &meshgrow::MeshReport::gamma_mean},
    {"sicn_min", &meshgrow::MeshReport::sicn_min},
    {"sicn_mean", &meshgrow::MeshReport::sicn_mean}};

json to_json(const meshgrow::MeshReport& report) {
  json result = {{"elements", report.elements}};
  for (const ReportKey& key : report_keys) {
    result[key.name] = number_or_null(report.*key.value);
  }
  return result;
}

/// Throws Error if it is none.
json parse_report(const char* text) {
  json report = json::parse(given(text, "A report"), nullptr, false);
  if (report.is_discarded()) {
    throw Error("A report is no JSON: give what meshgrow_report_json made.");
  }
  return report;
}

/// Of an entry of a table: {"name": …, "report": …}.
meshgrow::NamedReport named_report(const json& entry) {
  if (!entry.is_object() || !entry.contains("name") || !entry.at("name").is_string() ||
      !entry.contains("report")) {
    throw Error(
        "A table is made of a list of {\"name\": \"…\", \"report\": {…}}: give each report so.");
  }
  meshgrow::NamedReport named{entry.at("name").get<std::string>(), {}};
  const json& values = entry.at("report");
  const auto value = [&](const char* name) {
    if (!values.is_object() || !values.contains(name)) {
      throw Error("The report \"" + named.name + "\" has no value \"" + name +
                  "\": give one as it was made by report().");
    }
    return values.at(name);
  };
  const json elements = value("elements");
  if (!elements.is_number_unsigned()) {
    throw Error("The report \"" + named.name +
                "\" has no number of elements: give one as it was made by report().");
  }
  named.report.elements = elements.get<size_t>();
  for (const ReportKey& key : report_keys) {
    named.report.*key.value = number_or_unknown(value(key.name));
  }
  return named;
}

/// What a report is about; checks that these entities are there.
meshgrow::ReportMesh report_mesh(int dim, const int* entities, size_t entities_n) {
  if (dim != 2 && dim != 3) {
    throw Error("A report is about dimension 2 or 3, not " + std::to_string(dim) + ".");
  }
  meshgrow::gmsh::require_gmsh();
  const std::vector<Entity> asked = entities_of(entities, entities_n);
  const meshgrow::Topology topology = meshgrow::read_topology();
  for (const Entity& entity : asked) {
    if (entity.dim != dim || !topology.contains(entity)) {
      throw Error(meshgrow::entity_name(entity) + " is not a " + meshgrow::dimension_name(dim) +
                  " of the model: check its dimension and tag.");
    }
  }
  return meshgrow::read_report_mesh(dim, asked);
}

/// The sizes of the field, changed as Gmsh changes every size that it is told.
meshgrow::SizeAsked size_asked_of(meshgrow_field* field) {
  if (field == nullptr) {
    return {};
  }
  deref(field).refresh_if_needed();
  const double smallest = meshgrow::gmsh::option("Mesh.MeshSizeMin");
  const double largest = std::max(smallest, meshgrow::gmsh::option("Mesh.MeshSizeMax"));
  const double factor = meshgrow::gmsh::option("Mesh.MeshSizeFactor");
  return [=](const Entity& entity, const meshgrow::Vec3& p) {
    const double size = field->model_field.field().size(entity, p);
    return std::isfinite(size) ? factor * std::clamp(size, smallest, largest) : size;
  };
}

}  // namespace

char* meshgrow_report_json(int dim, const int* entities, size_t entities_n, meshgrow_field* field) {
  return guarded(static_cast<char*>(nullptr), [&] {
    const meshgrow::ReportMesh mesh = report_mesh(dim, entities, entities_n);
    return copy_text(
        meshgrow::json_text(to_json(meshgrow::make_report(mesh, size_asked_of(field)))));
  });
}

char* meshgrow_report_worst_json(int dim, const int* entities, size_t entities_n,
                                 meshgrow_field* field, const char* name, int largest,
                                 size_t count) {
  return guarded(static_cast<char*>(nullptr), [&] {
    const meshgrow::ReportMesh mesh = report_mesh(dim, entities, entities_n);
    given(name, "The name of a value");
    json places = json::array();
    for (const meshgrow::WorstPlace& place :
         meshgrow::worst_places(mesh, size_asked_of(field), name, largest != 0, count)) {
      places.push_back({{"value", number_or_null(place.value)},
                        {"elements", place.elements},
                        {"entity", {place.entity.dim, place.entity.tag}},
                        {"point", {place.point.x(), place.point.y(), place.point.z()}}});
    }
    return copy_text(meshgrow::json_text(places));
  });
}

int meshgrow_report_value(const char* report_json, const char* name, double* value) {
  return guarded(1, [&] {
    const json report = parse_report(report_json);
    given(name, "The name of a value");
    given(value, "The place for a value");
    if (!report.is_object() || !report.contains(name)) {
      throw Error(std::string("A report has no value \"") + name +
                  "\": give \"elements\", \"ratio_99\" or another of its names.");
    }
    *value = number_or_unknown(report.at(name));
    return 0;
  });
}

char* meshgrow_report_table(const char* reports_json) {
  return guarded(static_cast<char*>(nullptr), [&] {
    std::vector<meshgrow::NamedReport> reports;
    for (const json& entry : parse_report(reports_json)) {
      reports.push_back(named_report(entry));
    }
    return copy_text(meshgrow::report_table(reports));
  });
}
