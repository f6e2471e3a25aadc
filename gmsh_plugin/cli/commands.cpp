#include "commands.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "error.h"
#include "gmsh_api.h"
#include "meshgrow.h"
#include "model_reader.h"
#include "size_function_text.h"

namespace meshgrow::cli {

namespace {

namespace fs = std::filesystem;

/// Gmsh for the life of this object.
class GmshSession {
 public:
  explicit GmshSession(int verbosity) {
    gmsh::initialize({"meshgrow"});
    gmsh::set_option("General.Terminal", 1.0);
    gmsh::set_option("General.Verbosity", verbosity);
  }
  ~GmshSession() {
    try {
      gmsh::finalize();
    } catch (...) {
      // Nothing is left to lose at the end of the program.
    }
  }
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;
};

void check(int failed) {
  if (failed != 0) {
    throw Error(meshgrow_last_error());
  }
}

/// Owner of a text that the C interface returned.
std::string take_text(char* text) {
  check(text == nullptr ? 1 : 0);
  const std::string result = text;
  meshgrow_free(text);
  return result;
}

struct FieldDeleter {
  void operator()(meshgrow_field* field) const { meshgrow_field_destroy(field); }
};
using FieldPointer = std::unique_ptr<meshgrow_field, FieldDeleter>;

std::vector<std::string> definitions(const FieldArguments& arguments) {
  std::vector<std::string> result = arguments.size_functions;
  if (!arguments.file.empty()) {
    std::ifstream file(arguments.file);
    if (!file) {
      throw Error("Cannot read " + arguments.file + " (" + std::strerror(errno) +
                  "): give a file of size functions, one a line.");
    }
    for (std::string line; std::getline(file, line);) {
      const std::size_t first = line.find_first_not_of(" \t\r");
      if (first != std::string::npos && line[first] != '#') {
        result.push_back(line.substr(first, line.find_last_not_of(" \t\r") + 1 - first));
      }
    }
  }
  return result;
}

FieldPointer make_field(const FieldArguments& arguments, const std::vector<std::string>& texts) {
  FieldPointer field(meshgrow_field_create());
  check(field ? 0 : 1);
  check(meshgrow_field_set_option(field.get(), "tolerance", arguments.tolerance));
  const double evaluator = arguments.evaluator == "exact"  ? 2.0
                           : arguments.evaluator == "grid" ? 1.0
                                                           : 0.0;
  check(meshgrow_field_set_option(field.get(), "evaluator", evaluator));
  check(meshgrow_field_set_option(field.get(), "strict", arguments.strict ? 1.0 : 0.0));
  check(meshgrow_field_set_option(field.get(), "calibrate", arguments.calibrate ? 1.0 : 0.0));
  for (const std::string& text : texts) {
    check(meshgrow_field_add(field.get(), text.c_str()));
  }
  if (arguments.defaults_limit != 0.0) {
    constexpr double growth_rate = 1.2;
    check(meshgrow_field_create_defaults(field.get(), nullptr, 0, growth_rate,
                                         arguments.defaults_limit, 0.0));
  }
  return field;
}

void open_model(const std::string& file) {
  if (!std::ifstream(file)) {
    throw Error("Cannot read " + file + " (" + std::strerror(errno) +
                "): give a file that Gmsh can open.");
  }
  if (fs::is_directory(file)) {
    throw Error(file + " is a directory: give a file that Gmsh can open.");
  }
  std::string problem;
  try {
    gmsh::open(file);
    problem = gmsh::last_error();
  } catch (const Error& error) {
    problem = error.what();
  }
  if (!problem.empty()) {
    throw Error("Gmsh cannot read " + file + " (" + problem + "): correct the file.");
  }
  if (gmsh::entities().empty()) {
    throw Error(file + " holds no geometry and no mesh: give a model that Gmsh can read.");
  }
}

/// Where a mesh is written until it is complete; the ending stays, since it tells Gmsh the format.
fs::path unfinished_path(const fs::path& output) {
  fs::path path = output;
  path.replace_filename("." + output.stem().string() + ".unfinished" + output.extension().string());
  return path;
}

void check_writable(const fs::path& output) {
  const fs::path unfinished = unfinished_path(output);
  std::ofstream file(unfinished);
  const bool blocked = fs::is_directory(output);
  if (!file || blocked) {
    const std::string reason = blocked ? "it is a directory" : std::strerror(errno);
    throw Error("Cannot write " + output.string() + " (" + reason +
                "): choose another output with -o.");
  }
  file.close();
  fs::remove(unfinished);
}

void write_mesh(const fs::path& output) {
  const fs::path unfinished = unfinished_path(output);
  std::string problem;
  try {
    gmsh::write(unfinished.string());
  } catch (const Error& error) {
    problem = error.what();
  }
  std::error_code failed;
  if (!problem.empty() || !fs::exists(unfinished) || fs::file_size(unfinished, failed) == 0) {
    fs::remove(unfinished, failed);
    throw Error("Gmsh did not write " + output.string() +
                (problem.empty() ? "" : " (" + problem + ")") +
                ": choose an ending that it knows, such as .msh.");
  }
  fs::rename(unfinished, output);
}

}  // namespace

void mesh(const MeshArguments& arguments, const FieldArguments& field_arguments) {
  const int dim = arguments.dim_3 ? 3 : arguments.dim_2 ? 2 : arguments.dim_1 ? 1 : 3;
  const std::vector<std::string> texts = definitions(field_arguments);
  fs::path output = arguments.output;
  if (output.empty()) {
    output = fs::path(arguments.model).replace_extension(".msh");
  }
  if (fs::exists(output) && fs::exists(arguments.model) &&
      fs::equivalent(output, arguments.model)) {
    throw Error("The mesh would be written over the model " + arguments.model +
                ": name another output with -o.");
  }
  if (!arguments.plan) {
    check_writable(output);
  }

  const GmshSession session(arguments.verbosity);
  std::cout << "Reading " << arguments.model << std::endl;
  open_model(arguments.model);
  const FieldPointer field = make_field(field_arguments, texts);
  if (texts.empty() && field_arguments.defaults_limit == 0.0) {
    std::cout << "No size function is given: Gmsh's own sizes rule." << std::endl;
  }
  if (arguments.plan) {
    std::cout << take_text(meshgrow_field_plan(field.get(), dim)) << std::flush;
    return;
  }
  check(meshgrow_field_set_progress(
      field.get(),
      [](const char* line, void*) {
        std::cout << line << std::endl;
        return 0;
      },
      nullptr));
  check(meshgrow_field_generate(field.get(), dim, arguments.remesh ? 1 : 0));
  write_mesh(output);
  std::cout << '\n' << take_text(meshgrow_field_summary(field.get()));
  if (dim > 1) {
    const std::string measured = take_text(meshgrow_report_json(dim, nullptr, 0, field.get()));
    const nlohmann::json row = {{"name", output.filename().string()},
                                {"report", nlohmann::json::parse(measured)}};
    std::cout << '\n'
              << take_text(meshgrow_report_table(nlohmann::json::array({row}).dump().c_str()));
  }
  std::cout << "\nWrote " << output.string() << ". To look at it: gmsh " << output.string()
            << std::endl;
}

void report(const ReportArguments& arguments, const FieldArguments& field_arguments) {
  const std::vector<std::string> texts = definitions(field_arguments);
  const GmshSession session(2);
  nlohmann::json rows = nlohmann::json::array();
  for (const std::string& file : arguments.meshes) {
    open_model(file);
    const bool has_functions = !texts.empty() || field_arguments.defaults_limit != 0.0;
    const FieldPointer field = has_functions ? make_field(field_arguments, texts) : FieldPointer();
    std::vector<int> dim_tags;
    if (!arguments.entities.empty()) {
      for (const Entity& entity : parse_entities(arguments.entities, read_topology())) {
        dim_tags.push_back(entity.dim);
        dim_tags.push_back(entity.tag);
      }
    }
    const std::string measured = take_text(
        meshgrow_report_json(arguments.dim, dim_tags.data(), dim_tags.size(), field.get()));
    nlohmann::json values = nlohmann::json::parse(measured);
    if (values.at("elements") == 0) {
      throw Error(file + " has no elements of dimension " + std::to_string(arguments.dim) +
                  (arguments.entities.empty() ? "" : " on " + arguments.entities) +
                  ": mesh it first, or choose --dim.");
    }
    rows.push_back({{"name", file}, {"report", std::move(values)}});
  }
  if (arguments.json) {
    std::cout << rows.dump(2) << '\n';
  } else {
    std::cout << take_text(meshgrow_report_table(rows.dump().c_str()));
  }
}

}  // namespace meshgrow::cli
