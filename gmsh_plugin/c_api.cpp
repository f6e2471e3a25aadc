#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "c_field.h"
#include "error.h"
#include "field_view.h"
#include "gmsh_api.h"
#include "gmsh_state.h"
#include "mesh_report.h"
#include "meshgrow.h"
#include "model_reader.h"
#include "probe_json.h"
#include "size_function_text.h"
#include "worst_places.h"

namespace {

using meshgrow::Entity;
using meshgrow::Error;
using meshgrow::Kind;
using meshgrow::SizeFunction;
using nlohmann::json;

thread_local std::string last_error;

/// Runs the body; its exceptions become the thread's last error and the result `failed`.
template <typename Result, typename Body>
Result guarded(Result failed, Body body) noexcept {
  try {
    last_error.clear();
    return body();
  } catch (const std::bad_alloc&) {
    last_error = "Out of memory: raise the tolerance or use fewer facets.";
  } catch (const std::exception& error) {
    last_error = error.what();
  } catch (...) {
    last_error = "An unknown error occurred.";
  }
  return failed;
}

char* copy_text(const std::string& text) {
  char* copy = static_cast<char*>(std::malloc(text.size() + 1));
  if (copy == nullptr) {
    throw std::bad_alloc();
  }
  std::memcpy(copy, text.c_str(), text.size() + 1);
  return copy;
}

std::vector<Entity> entities_of(const int* dim_tags, size_t count) {
  if (count % 2 != 0) {
    throw Error("A list of entities has an odd number of ints: give pairs of dimension and tag.");
  }
  std::vector<Entity> result;
  for (size_t i = 0; i < count; i += 2) {
    result.push_back({dim_tags[i], dim_tags[i + 1]});
  }
  return result;
}

meshgrow::ModelField& deref(meshgrow_field* field) {
  if (field == nullptr) {
    throw Error("There is no size field: create one first.");
  }
  return field->model_field;
}

const SizeFunction& function_at(const meshgrow_field* field, size_t index) {
  if (index >= meshgrow_field_function_count(field)) {
    throw Error("There is no size function with the index " + std::to_string(index) +
                ": give one from 0 to the count of functions less one.");
  }
  return field->model_field.field().functions()[index];
}

/// What functions of all kinds have.
SizeFunction common(Kind kind, std::vector<Entity> sources, std::vector<Entity> attachments,
                    double growth_rate, double size_limit) {
  SizeFunction function;
  function.kind = kind;
  function.sources = std::move(sources);
  function.attachments = std::move(attachments);
  function.growth_rate = growth_rate;
  function.size_limit = size_limit;
  return function;
}

/// A negative dimension stands for no entity.
std::optional<Entity> optional_entity(int dim, int tag) {
  return dim < 0 ? std::nullopt : std::optional<Entity>({dim, tag});
}

using SizesOf = void (meshgrow::SizeField::*)(const Entity&, const meshgrow::Vec3*, std::size_t,
                                              double*) const;

int sizes_at(meshgrow_field* field, SizesOf sizes_of, int dim, int tag, const double* points,
             size_t points_n, double* sizes) {
  return guarded(1, [&] {
    deref(field).refresh_if_needed();
    const meshgrow::SizeField& size_field = deref(field).field();
    if (!size_field.topology().contains({dim, tag})) {
      throw Error(meshgrow::entity_name({dim, tag}) +
                  " is not in the model: check its dimension and tag.");
    }
    // A vector is its three coordinates and nothing else, so the caller's array is read in place.
    static_assert(sizeof(meshgrow::Vec3) == 3 * sizeof(double) &&
                  alignof(meshgrow::Vec3) == alignof(double));
    (size_field.*sizes_of)({dim, tag}, reinterpret_cast<const meshgrow::Vec3*>(points), points_n,
                           sizes);
    return 0;
  });
}

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

meshgrow::MeshReport report_from(const json& text) {
  meshgrow::MeshReport report;
  report.elements = text.at("elements").get<size_t>();
  for (const ReportKey& key : report_keys) {
    report.*key.value = number_or_unknown(text.at(key.name));
  }
  return report;
}

json dim_tags(const std::vector<Entity>& entities) {
  json result = json::array();
  for (const Entity& entity : entities) {
    result.push_back({entity.dim, entity.tag});
  }
  return result;
}

json summary_json(const meshgrow::SizeField& field) {
  json functions = json::array();
  for (size_t i = 0; i < field.functions().size(); ++i) {
    const SizeFunction& function = field.functions()[i];
    functions.push_back({{"name", function.name},
                         {"kind", meshgrow::kind_name(function.kind)},
                         {"text", meshgrow::size_function_text(function)},
                         {"sources", dim_tags(function.sources)},
                         {"attachments", dim_tags(function.attachments)},
                         {"growth_rate", function.growth_rate},
                         {"size_limit", function.size_limit},
                         {"effective", field.is_effective(i)}});
  }
  json groups = json::array();
  for (const meshgrow::SizeField::GroupSummary& group : field.groups()) {
    json entry = {{"entities", dim_tags(group.entities)},
                  {"functions", group.functions},
                  {"facets", group.facets},
                  {"tree_bytes", group.tree_bytes},
                  {"tree_seconds", group.tree_seconds},
                  {"answers", group.answers},
                  {"exact_answers", group.exact_answers},
                  {"grid", nullptr}};
    if (group.has_grid) {
      entry["grid"] = {{"interpolated_cells", group.grid.interpolated_leaves},
                       {"exact_cells", group.grid.exact_leaves},
                       {"depth", group.grid.depth},
                       {"bytes", group.grid.bytes},
                       {"seconds", group.grid.seconds}};
    }
    groups.push_back(entry);
  }
  return {{"functions", functions}, {"groups", groups}};
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

void set_option(meshgrow::ModelField& model_field, const std::string& name, double value) {
  meshgrow::FieldOptions& options = model_field.field().options();
  if (name == "tolerance") {
    meshgrow::check_tolerance(value);
    options.tolerance = value;
  } else if (name == "threads") {
    if (!(value >= 0.0 && value <= 1024.0)) {
      throw Error("The number of threads must be from 0 (all) to 1024.");
    }
    options.threads = static_cast<int>(value);
  } else if (name == "evaluator") {
    if (value != 0.0 && value != 1.0 && value != 2.0) {
      throw Error("The evaluator must be 0 (auto), 1 (grid) or 2 (exact).");
    }
    options.evaluator = static_cast<meshgrow::Evaluator>(static_cast<int>(value));
  } else if (name == "strict") {
    model_field.set_strict(value != 0.0);
  } else if (name == "calibrate") {
    model_field.set_calibrate(value != 0.0);
  } else {
    throw Error("There is no option \"" + name +
                "\": give \"tolerance\", \"threads\", \"evaluator\", \"strict\" or \"calibrate\".");
  }
}

}  // namespace

const char* meshgrow_version(void) { return MESHGROW_VERSION; }

const char* meshgrow_last_error(void) { return last_error.c_str(); }

void meshgrow_free(char* text) { std::free(text); }

meshgrow_field* meshgrow_field_create(void) {
  return guarded(static_cast<meshgrow_field*>(nullptr), [] { return new meshgrow_field(); });
}

void meshgrow_field_destroy(meshgrow_field* field) { delete field; }

int meshgrow_field_add_mesh(meshgrow_field* field, const int* sources, size_t sources_n,
                            const int* attach, size_t attach_n, double growth_rate,
                            double size_limit, int quad_sides) {
  return guarded(1, [&] {
    SizeFunction function = common(Kind::mesh, entities_of(sources, sources_n),
                                   entities_of(attach, attach_n), growth_rate, size_limit);
    function.quad_size =
        quad_sides != 0 ? meshgrow::QuadSize::sides : meshgrow::QuadSize::triangles;
    deref(field).add(std::move(function));
    return 0;
  });
}

int meshgrow_field_add_fixed(meshgrow_field* field, const int* sources, size_t sources_n,
                             const int* attach, size_t attach_n, double size, double growth_rate,
                             double size_limit) {
  return guarded(1, [&] {
    SizeFunction function = common(Kind::fixed, entities_of(sources, sources_n),
                                   entities_of(attach, attach_n), growth_rate, size_limit);
    function.start_size = size;
    deref(field).add(std::move(function));
    return 0;
  });
}

int meshgrow_field_add_curvature(meshgrow_field* field, const int* sources, size_t sources_n,
                                 const int* attach, size_t attach_n, double angle,
                                 double growth_rate, double size_limit, double min_size) {
  return guarded(1, [&] {
    SizeFunction function = common(Kind::curvature, entities_of(sources, sources_n),
                                   entities_of(attach, attach_n), growth_rate, size_limit);
    function.angle = angle;
    function.min_size = min_size;
    deref(field).add(std::move(function));
    return 0;
  });
}

int meshgrow_field_add_proximity(meshgrow_field* field, const int* sources, size_t sources_n,
                                 const int* attach, size_t attach_n, double cells_per_gap,
                                 double growth_rate, double size_limit, double min_size,
                                 int between) {
  return guarded(1, [&] {
    if (between < MESHGROW_BETWEEN_AUTOMATIC || between > MESHGROW_BETWEEN_BOTH) {
      throw Error("Gaps are between faces, edges or both: give one of MESHGROW_BETWEEN_….");
    }
    SizeFunction function = common(Kind::proximity, entities_of(sources, sources_n),
                                   entities_of(attach, attach_n), growth_rate, size_limit);
    function.cells_per_gap = cells_per_gap;
    function.min_size = min_size;
    function.between = static_cast<meshgrow::GapsBetween>(between);
    deref(field).add(std::move(function));
    return 0;
  });
}

int meshgrow_field_create_defaults(meshgrow_field* field, const int* attach, size_t attach_n,
                                   double growth_rate, double size_limit, double min_size) {
  return guarded(1, [&] {
    deref(field).create_defaults(entities_of(attach, attach_n), growth_rate, size_limit, min_size);
    return 0;
  });
}

int meshgrow_field_add(meshgrow_field* field, const char* text) {
  return guarded(1, [&] {
    deref(field).add(std::string(text));
    return 0;
  });
}

size_t meshgrow_field_function_count(const meshgrow_field* field) {
  return field == nullptr ? 0 : field->model_field.field().functions().size();
}

char* meshgrow_field_function_name(const meshgrow_field* field, size_t index) {
  return guarded(static_cast<char*>(nullptr),
                 [&] { return copy_text(function_at(field, index).name); });
}

char* meshgrow_field_function_text(const meshgrow_field* field, size_t index) {
  return guarded(static_cast<char*>(nullptr), [&] {
    return copy_text(meshgrow::size_function_text(function_at(field, index)));
  });
}

int meshgrow_field_rename(meshgrow_field* field, const char* name, const char* new_name) {
  return guarded(1, [&] {
    deref(field).rename(name, new_name);
    return 0;
  });
}

int meshgrow_field_modify(meshgrow_field* field, const char* name, const char* text) {
  return guarded(1, [&] {
    deref(field).modify(name, text);
    return 0;
  });
}

int meshgrow_field_remove(meshgrow_field* field, const char* name) {
  return guarded(1, [&] {
    deref(field).remove(name);
    return 0;
  });
}

int meshgrow_field_save(meshgrow_field* field, const char* path) {
  return guarded(1, [&] {
    deref(field).save(path);
    return 0;
  });
}

meshgrow_field* meshgrow_field_load(const char* path) {
  return guarded(static_cast<meshgrow_field*>(nullptr), [&] { return new meshgrow_field(path); });
}

int meshgrow_field_set_option(meshgrow_field* field, const char* name, double value) {
  return guarded(1, [&] {
    set_option(deref(field), name, value);
    return 0;
  });
}

int meshgrow_field_set_progress(meshgrow_field* field,
                                int (*listener)(const char* line, void* data), void* data) {
  return guarded(1, [&] {
    meshgrow::ModelField::ProgressListener call;
    if (listener != nullptr) {
      call = [listener, data](const std::string& line) {
        if (listener(line.c_str(), data) != 0) {
          throw Error("Stopped by the listener of progress; what was meshed before is kept.");
        }
      };
    }
    deref(field).set_progress_listener(call);
    return 0;
  });
}

int meshgrow_field_set_stop(meshgrow_field* field, int (*wants_stop)(void* data), void* data) {
  return guarded(1, [&] {
    std::function<bool()> call;
    if (wants_stop != nullptr) {
      call = [wants_stop, data] { return wants_stop(data) != 0; };
    }
    deref(field).set_stop_request(std::move(call));
    return 0;
  });
}

int meshgrow_field_refresh(meshgrow_field* field) {
  return guarded(1, [&] {
    deref(field).refresh();
    return 0;
  });
}

int meshgrow_field_register(meshgrow_field* field) {
  return guarded(1, [&] {
    deref(field).register_callback();
    return 0;
  });
}

int meshgrow_field_unregister(meshgrow_field* field) {
  return guarded(1, [&] {
    deref(field).unregister_callback();
    return 0;
  });
}

int meshgrow_field_generate(meshgrow_field* field, int dim, int remesh) {
  return guarded(1, [&] {
    deref(field).generate(dim, remesh != 0);
    return 0;
  });
}

char* meshgrow_field_plan(meshgrow_field* field, int dim) {
  return guarded(static_cast<char*>(nullptr), [&] {
    const meshgrow::ModelField& model_field = deref(field);
    return copy_text(meshgrow::plan_text(model_field.plan(dim), model_field.field().functions()));
  });
}

char* meshgrow_field_plan_json(meshgrow_field* field, int dim) {
  return guarded(static_cast<char*>(nullptr), [&] {
    json passes = json::array();
    for (const meshgrow::MeshingPass& pass : deref(field).plan(dim)) {
      passes.push_back({{"dim", pass.dim},
                        {"attached", pass.attached},
                        {"entities", dim_tags(pass.entities)},
                        {"functions", pass.functions},
                        {"sources", dim_tags(pass.sources)}});
    }
    return copy_text(passes.dump());
  });
}

int meshgrow_field_combine(meshgrow_field* field,
                           double (*sizes)(int dim, int tag, double x, double y, double z,
                                           double size_so_far, void* data),
                           void* data) {
  return guarded(1, [&] {
    meshgrow::UserSizes call;
    if (sizes != nullptr) {
      call = [sizes, data](int dim, int tag, double x, double y, double z, double so_far) {
        return sizes(dim, tag, x, y, z, so_far, data);
      };
    }
    deref(field).combine(call);
    return 0;
  });
}

int meshgrow_field_size(meshgrow_field* field, int dim, int tag, const double* points,
                        size_t points_n, double* sizes) {
  return sizes_at(field, &meshgrow::SizeField::sizes, dim, tag, points, points_n, sizes);
}

int meshgrow_field_exact_size(meshgrow_field* field, int dim, int tag, const double* points,
                              size_t points_n, double* sizes) {
  return sizes_at(field, &meshgrow::SizeField::exact_sizes, dim, tag, points, points_n, sizes);
}

int meshgrow_field_smallest_size(meshgrow_field* field, const double* points, size_t points_n,
                                 double* sizes) {
  return guarded(1, [&] {
    deref(field).refresh_if_needed();
    std::vector<meshgrow::Vec3> at;
    at.reserve(points_n);
    for (size_t i = 0; i < points_n; ++i) {
      at.emplace_back(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
    }
    deref(field).field().smallest_sizes(at.data(), points_n, sizes);
    return 0;
  });
}

int meshgrow_field_add_view(meshgrow_field* field, const char* name, const char* kind, int dim,
                            int tag, const double* plane, int resolution, int* view_tag) {
  return guarded(1, [&] {
    meshgrow::ViewRequest request;
    request.name = name;
    request.kind = meshgrow::view_kind(kind);
    request.entity = optional_entity(dim, tag);
    if (plane != nullptr) {
      request.plane = {{plane[0], plane[1], plane[2]}, {plane[3], plane[4], plane[5]}};
    }
    if (resolution != 0) {
      request.resolution = resolution;
    }
    *view_tag = meshgrow::add_view(deref(field), request);
    return 0;
  });
}

int meshgrow_field_write_view(meshgrow_field* field, const char* path, int dim, int tag,
                              size_t* cells) {
  return guarded(1, [&] {
    const std::size_t written = meshgrow::write_view(deref(field), optional_entity(dim, tag), path);
    if (cells != nullptr) {
      *cells = written;
    }
    return 0;
  });
}

char* meshgrow_field_probe_json(meshgrow_field* field, int dim, int tag, const double* point) {
  return guarded(static_cast<char*>(nullptr), [&] {
    deref(field).refresh_if_needed();
    const meshgrow::SizeField& size_field = deref(field).field();
    if (!size_field.topology().contains({dim, tag})) {
      throw Error(meshgrow::entity_name({dim, tag}) +
                  " is not in the model: check its dimension and tag.");
    }
    const meshgrow::Vec3 p(point[0], point[1], point[2]);
    if (!p.allFinite()) {
      throw Error("A point to probe has a coordinate that is not finite: give three numbers.");
    }
    const meshgrow::Probe found = size_field.probe({dim, tag}, p);
    if (deref(field).is_from_file()) {
      return copy_text(meshgrow::probe_json(size_field, found, p, false).dump());
    }
    const meshgrow::CurrentModel current(deref(field).model());
    return copy_text(meshgrow::probe_json(size_field, found, p, true).dump());
  });
}

double meshgrow_field_answer(const meshgrow_field* field, int dim, int tag, double x, double y,
                             double z, double proposed) {
  return field == nullptr ? proposed
                          : field->model_field.answers().answer(dim, tag, x, y, z, proposed);
}

double meshgrow_field_callback(int dim, int tag, double x, double y, double z, double proposed,
                               void* field) {
  return field == nullptr ? proposed
                          : static_cast<meshgrow_field*>(field)->model_field.answer_call(
                                dim, tag, x, y, z, proposed);
}

double meshgrow_field_callback_4_8(int dim, int tag, double x, double y, double z, void* field) {
  return meshgrow_field_callback(dim, tag, x, y, z, meshgrow::gmsh_no_size, field);
}

char* meshgrow_field_summary(meshgrow_field* field) {
  return guarded(static_cast<char*>(nullptr), [&] {
    deref(field).read_if_needed();
    return copy_text(deref(field).field().summary());
  });
}

char* meshgrow_field_summary_json(meshgrow_field* field) {
  return guarded(static_cast<char*>(nullptr), [&] {
    deref(field).read_if_needed();
    return copy_text(summary_json(deref(field).field()).dump());
  });
}

char* meshgrow_report_json(int dim, const int* entities, size_t entities_n, meshgrow_field* field) {
  return guarded(static_cast<char*>(nullptr), [&] {
    const meshgrow::ReportMesh mesh = report_mesh(dim, entities, entities_n);
    return copy_text(to_json(meshgrow::make_report(mesh, size_asked_of(field))).dump());
  });
}

char* meshgrow_report_worst_json(int dim, const int* entities, size_t entities_n,
                                 meshgrow_field* field, const char* name, int largest,
                                 size_t count) {
  return guarded(static_cast<char*>(nullptr), [&] {
    const meshgrow::ReportMesh mesh = report_mesh(dim, entities, entities_n);
    json places = json::array();
    for (const meshgrow::WorstPlace& place :
         meshgrow::worst_places(mesh, size_asked_of(field), name, largest != 0, count)) {
      places.push_back({{"value", number_or_null(place.value)},
                        {"elements", place.elements},
                        {"entity", {place.entity.dim, place.entity.tag}},
                        {"point", {place.point.x(), place.point.y(), place.point.z()}}});
    }
    return copy_text(places.dump());
  });
}

int meshgrow_report_value(const char* report_json, const char* name, double* value) {
  return guarded(1, [&] {
    const json report = json::parse(report_json);
    if (!report.contains(name)) {
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
    for (const json& entry : json::parse(reports_json)) {
      reports.push_back({entry.at("name").get<std::string>(), report_from(entry.at("report"))});
    }
    return copy_text(meshgrow::report_table(reports));
  });
}
