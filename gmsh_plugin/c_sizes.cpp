// The C interface: what a field answers and shows.

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "c_guard.h"
#include "error.h"
#include "field_view.h"
#include "gmsh_state.h"
#include "json_text.h"
#include "meshgrow.h"
#include "probe_json.h"
#include "size_function_text.h"

namespace {

using meshgrow::Entity;
using meshgrow::Error;
using namespace meshgrow::c;
using meshgrow::SizeFunction;
using nlohmann::json;

/// A negative dimension stands for no entity.
std::optional<Entity> optional_entity(int dim, int tag) {
  return dim < 0 ? std::nullopt : std::optional<Entity>({dim, tag});
}

using SizesOf = void (meshgrow::SizeField::*)(const Entity&, const meshgrow::Vec3*, std::size_t,
                                              double*) const;

int sizes_at(meshgrow_field* field, SizesOf sizes_of, int dim, int tag, const double* points,
             size_t points_n, double* sizes) {
  return guarded(1, [&] {
    given(points, points_n, "The array of points");
    given(sizes, points_n, "The array for sizes");
    deref(field).ask([&](const meshgrow::SizeField& size_field) {
      if (!size_field.topology().contains({dim, tag})) {
        throw Error(meshgrow::entity_name({dim, tag}) +
                    " is not in the model: check its dimension and tag.");
      }
      // A vector is its three coordinates and nothing else, so the caller's array is read in place.
      static_assert(sizeof(meshgrow::Vec3) == 3 * sizeof(double) &&
                    alignof(meshgrow::Vec3) == alignof(double));
      (size_field.*sizes_of)({dim, tag}, reinterpret_cast<const meshgrow::Vec3*>(points), points_n,
                             sizes);
    });
    return 0;
  });
}

json dim_tags(const std::vector<Entity>& entities) {
  json result = json::array();
  for (const Entity& entity : entities) {
    result.push_back({entity.dim, entity.tag});
  }
  return result;
}

json summary_json(const meshgrow::ModelField& model_field) {
  const meshgrow::SizeField& field = model_field.field();
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
                       {"limited", group.grid.is_limited},
                       {"bytes", group.grid.bytes},
                       {"seconds", group.grid.seconds}};
    }
    groups.push_back(entry);
  }
  const meshgrow::ModelField::RunTimes& times = model_field.run_times();
  return {{"functions", functions},
          {"groups", groups},
          {"seconds", {{"gmsh", times.gmsh}, {"meshgrow", times.meshgrow}}}};
}

}  // namespace

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
    return copy_text(meshgrow::json_text(passes));
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
    given(points, points_n, "The array of points");
    given(sizes, points_n, "The array for sizes");
    std::vector<meshgrow::Vec3> at;
    at.reserve(points_n);
    for (size_t i = 0; i < points_n; ++i) {
      at.emplace_back(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
    }
    deref(field).ask([&](const meshgrow::SizeField& size_field) {
      size_field.smallest_sizes(at.data(), points_n, sizes);
    });
    return 0;
  });
}

int meshgrow_field_add_view(meshgrow_field* field, const char* name, const char* kind, int dim,
                            int tag, const double* plane, int resolution, int* view_tag) {
  return guarded(1, [&] {
    given(view_tag, "The place for the tag of a view");
    meshgrow::ViewRequest request;
    request.name = given(name, "The name of a view");
    request.kind = meshgrow::view_kind(given(kind, "The kind of a view"));
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
    const std::size_t written = meshgrow::write_view(deref(field), optional_entity(dim, tag),
                                                     given(path, "The path of a size field"));
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
    given(point, "The point to probe");
    const meshgrow::Vec3 p(point[0], point[1], point[2]);
    if (!p.allFinite()) {
      throw Error("A point to probe has a coordinate that is not finite: give three numbers.");
    }
    const meshgrow::Probe found = size_field.probe({dim, tag}, p);
    if (deref(field).is_from_file()) {
      return copy_text(meshgrow::json_text(meshgrow::probe_json(size_field, found, p, false)));
    }
    const meshgrow::CurrentModel current(deref(field).model());
    return copy_text(meshgrow::json_text(meshgrow::probe_json(size_field, found, p, true)));
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
    return copy_text(meshgrow::json_text(summary_json(deref(field))));
  });
}
