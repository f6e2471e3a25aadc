#include "mesh_command.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "c_results.h"
#include "error.h"
#include "field_arguments.h"
#include "gmsh_session.h"
#include "model_file.h"
#include "output_file.h"

namespace meshgrow::cli {

namespace {

namespace fs = std::filesystem;

struct MeshArguments {
  std::string model;
  std::string output;
  bool dim_1 = false;
  bool dim_2 = false;
  bool dim_3 = false;
  bool plan = false;
  bool remesh = false;
  int verbosity = 2;
  FieldArguments field;
};

fs::path output_of(const MeshArguments& arguments) {
  fs::path output = arguments.output;
  if (output.empty()) {
    output = fs::path(arguments.model).replace_extension(".msh");
  }
  if (fs::exists(output) && fs::exists(arguments.model) &&
      fs::equivalent(output, arguments.model)) {
    throw Error("The mesh would be written over the model " + arguments.model +
                ": name another output with -o.");
  }
  return output;
}

void mesh(const MeshArguments& arguments) {
  const int dim = arguments.dim_3 ? 3 : arguments.dim_2 ? 2 : arguments.dim_1 ? 1 : 3;
  const std::vector<std::string> texts = size_function_texts(arguments.field);
  const fs::path output = output_of(arguments);
  if (!arguments.plan) {
    check_writable(output);
  }

  const GmshSession session(arguments.verbosity);
  std::cout << "Reading " << arguments.model << std::endl;
  open_model(arguments.model);
  const FieldPointer field = make_field(arguments.field, texts);
  if (texts.empty() && arguments.field.defaults_limit == 0.0) {
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

}  // namespace

void add_mesh_command(CLI::App& program) {
  const auto arguments = std::make_shared<MeshArguments>();
  CLI::App& command =
      *program.add_subcommand("mesh", "Mesh a model, sources of size functions first");
  command.add_option("model", arguments->model, "What Gmsh can open: .geo, .step, .brep, .msh …")
      ->required();
  command.add_flag("-1", arguments->dim_1, "Mesh curves");
  command.add_flag("-2", arguments->dim_2, "Mesh curves and surfaces");
  command.add_flag("-3", arguments->dim_3, "Mesh all (the default)");
  command.add_option("-o,--output", arguments->output,
                     "Mesh file; its ending tells the format (default: the model's name, .msh)");
  command.add_flag("--plan", arguments->plan, "Print the passes and mesh nothing");
  command.add_flag("--remesh", arguments->remesh,
                   "Mesh again all that is no source of a mesh size function");
  command.add_option("-v", arguments->verbosity, "Gmsh's verbosity, 0 to 99")
      ->capture_default_str();
  add_field_options(command, arguments->field);
  command.callback([arguments] { mesh(*arguments); });
}

}  // namespace meshgrow::cli
