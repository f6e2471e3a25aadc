#include "field_command.h"

#include <CLI/Validators.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "c_field.h"
#include "c_results.h"
#include "entity_text.h"
#include "error.h"
#include "field_arguments.h"
#include "field_file.h"
#include "field_view.h"
#include "gmsh_session.h"
#include "interruption.h"
#include "model_file.h"
#include "number_text.h"
#include "progress.h"
#include "quoted_text.h"
#include "usage_error.h"
#include "whole_file.h"

namespace meshgrow::cli {

namespace {

namespace fs = std::filesystem;

struct FieldCommandArguments {
  std::string model;
  std::string output;
  std::string entity;  ///< "3,2"; empty for the smallest size of all functions
  bool dim_1 = false;
  bool dim_2 = false;
  int verbosity = 2;
  FieldArguments field;
};

bool is_saved_field(const std::string& path) { return fs::path(path).extension() == ".mgf"; }

void print_next_steps(const std::string& output) {
  const std::string ending = fs::path(output).extension().string();
  if (ending == ".vtu") {
    std::cout << "To look at it: paraview " << shell_quoted(output) << '\n';
    return;
  }
  if (is_saved_field(output)) {
    std::cout << "In Python: field = meshgrow.SizeField.load(" << double_quoted(output) << ")\n"
              << "In the .geo of an unchanged Gmsh:\n"
              << "  Field[1] = ExternalProcess; Field[1].CommandLine = "
              << double_quoted("meshgrow serve " + shell_quoted(output))
              << ";\n  Background Field = 1; Mesh.MeshSizeExtendFromBoundary = 0;\n";
    return;
  }
  std::cout << "To look at it: gmsh " << shell_quoted(output) << '\n';
  if (ending == ".pos") {
    std::cout << "As the background field of a model, in its .geo:\n"
              << "  Merge " << double_quoted(output) << ";\n"
              << "  Field[1] = PostView; Field[1].ViewIndex = 0; Background Field = 1;\n"
              << "  Mesh.MeshSizeExtendFromBoundary = 0;\n";
  }
}

/// The field of a model, with all its sources. Needs Gmsh.
FieldPointer field_of_model(const FieldCommandArguments& arguments,
                            const std::vector<std::string>& texts, Progress& progress) {
  std::cout << "Reading " << arguments.model << std::endl;
  open_model(arguments.model);
  if (!has_size_functions(arguments.field, texts)) {
    throw UsageError(
        "There is no size function, hence no size field: give --size-function, --size-functions or "
        "--defaults.");
  }
  FieldPointer field = make_field(arguments.field, texts);
  show_progress(field.get(), progress);
  const int dim = arguments.dim_2 ? 2 : arguments.dim_1 ? 1 : 0;
  if (dim > 0) {
    check(meshgrow_field_generate(field.get(), dim, 0));
  }
  // A field without its sources is not the one that was asked for.
  check(meshgrow_field_set_option(field.get(), "strict", 1.0));
  if (meshgrow_field_refresh(field.get()) != 0) {
    const std::string problem = meshgrow_last_error();
    throw Error(dim == 2 || problem.find(" no mesh") == std::string::npos
                    ? problem
                    : problem + " -1 meshes curves, -2 surfaces as well.");
  }
  return field;
}

/// Writes in the format of the ending; returns how many cells.
std::size_t write(meshgrow_field* field, const std::string& output,
                  const std::string& entity_text) {
  std::size_t cells = 0;
  remove_when_interrupted(unfinished_name(output));
  if (is_saved_field(output)) {
    check(meshgrow_field_save(field, output.c_str()));
  } else {
    Entity entity = {-1, 0};  // none
    if (!entity_text.empty()) {
      entity = read_entity(entity_text, field->model_field.field().topology());
    }
    check(meshgrow_field_write_view(field, output.c_str(), entity.dim, entity.tag, &cells));
  }
  tell_that_it_is_written();
  remove_when_interrupted("");
  return cells;
}

void tell_written(meshgrow_field* field, const std::string& output, std::size_t cells) {
  std::cout << '\n' << take_text(meshgrow_field_summary(field)) << "\nWrote " << output << ": ";
  if (cells > 0) {
    std::cout << grouped_digits(cells) << " cells, ";
  }
  std::cout << rounded(static_cast<double>(fs::file_size(output)) / 1e6, 1) << " MB.\n";
  print_next_steps(output);
}

void write_field(const FieldCommandArguments& arguments) {
  const std::vector<std::string> texts = size_function_texts(arguments.field);
  const bool from_file = is_field_file(arguments.model);
  if (from_file) {
    check_no_field_options(arguments.model, arguments.field);
  }
  if (!is_saved_field(arguments.output)) {
    try {
      check_view_ending(arguments.output);
    } catch (const Error& error) {
      throw UsageError(error.what());
    }
  } else if (!arguments.entity.empty()) {
    throw UsageError("A saved field (.mgf) is that of all entities: leave out --entity.");
  }
  if (fs::exists(arguments.output) && fs::exists(arguments.model) &&
      fs::equivalent(arguments.output, arguments.model)) {
    throw UsageError("The size field would be written over the model " + arguments.model +
                     ": name another output with -o.");
  }
  if (from_file) {
    end_when_interrupted("size field");
    const FieldPointer field(meshgrow_field_load(arguments.model.c_str()));
    check(field ? 0 : 1);
    tell_written(field.get(), arguments.output,
                 write(field.get(), arguments.output, arguments.entity));
    return;
  }
  const GmshSession session({"-v", std::to_string(arguments.verbosity)});
  end_when_interrupted("size field");  // Gmsh, too, sets what signals do
  FieldPointer field;
  std::size_t cells = 0;
  {
    Progress progress;
    field = field_of_model(arguments, texts, progress);
    cells = write(field.get(), arguments.output, arguments.entity);
    meshgrow_field_set_progress(field.get(), nullptr, nullptr);
  }
  tell_written(field.get(), arguments.output, cells);
}

}  // namespace

void add_field_command(CLI::App& program) {
  const auto arguments = std::make_shared<FieldCommandArguments>();
  CLI::App& command =
      *program.add_subcommand("field", "Write the size field, to look at or to use");
  command
      .add_option("model", arguments->model,
                  "What Gmsh can open, with the meshes of sources; or a saved field (.mgf)")
      ->required();
  command
      .add_option("-o,--output", arguments->output,
                  ".vtu (ParaView), .pos (Gmsh: also a background field), .msh (Gmsh) or .mgf "
                  "(to be loaded, served or written as another)")
      ->required();
  command.add_option(
      "--entity", arguments->entity,
      "The field of one entity, such as 3,2 for Volume 2 (default: the smallest size "
      "that any function asks for)");
  command.add_flag("-1", arguments->dim_1, "Mesh curves first, for sources without a mesh");
  command.add_flag("-2", arguments->dim_2, "Mesh curves and surfaces first");
  command.add_option("-v", arguments->verbosity, "Gmsh's verbosity, 0 to 99")
      ->capture_default_str();
  add_field_options(command, arguments->field);
  command.footer(
      std::string("Example:\n"
                  "  meshgrow field model.geo -2 -o sizes.pos --size-function 'mesh source "
                  "Surface{7} attach Volume{2} growth 1.2 limit 2'\n") +
      exit_codes_help);
  command.callback([arguments] { write_field(*arguments); });
}

}  // namespace meshgrow::cli
