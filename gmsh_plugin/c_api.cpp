// The C interface: fields, their size functions, options and meshing.

#include <cstdlib>
#include <string>

#include "c_guard.h"
#include "error.h"
#include "meshgrow.h"
#include "size_function_text.h"

namespace {

using meshgrow::Entity;
using meshgrow::Error;
using namespace meshgrow::c;
using meshgrow::Kind;
using meshgrow::SizeFunction;

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

void set_option(meshgrow::ModelField& model_field, const std::string& name, double value) {
  meshgrow::FieldOptions& options = model_field.field().options();
  if (model_field.is_from_file() && (name == "tolerance" || name == "evaluator")) {
    throw Error("A saved size field keeps its " + name + ": set it before saving.");
  }
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
  } else if (name == "max_cells") {
    meshgrow::check_max_cells(value);
    options.max_cells = static_cast<std::size_t>(value);
  } else if (name == "strict") {
    model_field.set_strict(value != 0.0);
  } else if (name == "calibrate") {
    model_field.set_calibrate(value != 0.0);
  } else {
    throw Error("There is no option \"" + name +
                "\": give \"tolerance\", \"threads\", \"max_cells\", \"evaluator\", \"strict\" or "
                "\"calibrate\".");
  }
}

}  // namespace

const char* meshgrow_version(void) { return MESHGROW_VERSION; }

const char* meshgrow_last_error(void) { return last_error(); }

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
    deref(field).add(std::string(given(text, "The text of a size function")));
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
    deref(field).rename(given(name, "The name of a size function"),
                        given(new_name, "The new name of a size function"));
    return 0;
  });
}

int meshgrow_field_modify(meshgrow_field* field, const char* name, const char* text) {
  return guarded(1, [&] {
    deref(field).modify(given(name, "The name of a size function"),
                        given(text, "The text of a size function"));
    return 0;
  });
}

int meshgrow_field_remove(meshgrow_field* field, const char* name) {
  return guarded(1, [&] {
    deref(field).remove(given(name, "The name of a size function"));
    return 0;
  });
}

int meshgrow_field_save(meshgrow_field* field, const char* path) {
  return guarded(1, [&] {
    deref(field).save(given(path, "The path of a size field"));
    return 0;
  });
}

meshgrow_field* meshgrow_field_load(const char* path) {
  return guarded(static_cast<meshgrow_field*>(nullptr),
                 [&] { return new meshgrow_field(given(path, "The path of a size field")); });
}

int meshgrow_field_set_option(meshgrow_field* field, const char* name, double value) {
  return guarded(1, [&] {
    set_option(deref(field), given(name, "The name of an option"), value);
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
