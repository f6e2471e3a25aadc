#include "mesh_command.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "c_results.h"
#include "fail_conditions.h"
#include "field_arguments.h"
#include "gmsh_api.h"
#include "gmsh_command_line.h"
#include "gmsh_session.h"
#include "interruption.h"
#include "json_text.h"
#include "model_file.h"
#include "onelab_functions.h"
#include "output_file.h"
#include "progress.h"
#include "quoted_text.h"
#include "usage_error.h"

namespace meshgrow::cli {

namespace {

namespace fs = std::filesystem;

struct MeshArguments {
  std::vector<std::string> models;
  std::string output;
  std::string report;
  std::vector<std::string> fail_if;
  bool plan = false;
  bool remesh = false;
  FieldArguments field;
  GmshCommandLine gmsh;
};

/// Where the mesh goes; Mesh.Format may be set by the model, so it is known once that is read.
fs::path output_of(const MeshArguments& arguments) {
  fs::path output = arguments.output;
  if (output.empty()) {
    const std::string ending = ending_of_format();
    output = fs::path(arguments.models.front()).replace_extension(ending.empty() ? ".msh" : ending);
  }
  for (const std::string& model : arguments.models) {
    if (fs::exists(output) && fs::exists(model) && fs::equivalent(output, model)) {
      throw UsageError("The mesh would be written over the model " + model +
                       ": name another output with -o.");
    }
  }
  return output;
}

/// The highest dimension up to `dim` of which there are elements, 0 if there are none.
int meshed_dimension(int dim) {
  int result = 0;
  for (const Entity& entity : gmsh::entities()) {
    if (entity.dim > result && entity.dim <= dim && gmsh::has_elements(entity)) {
      result = entity.dim;
    }
  }
  return result;
}

/// What Gmsh's own generate does after meshing if it is asked for (-optimize_ho).
void optimize_high_order() {
  const auto method = static_cast<int>(gmsh::option("Mesh.HighOrderOptimize"));
  if (gmsh::option("Mesh.ElementOrder") < 2.0) {
    return;
  }
  if (method == 2 || method == 3) {
    gmsh::optimize("HighOrderElastic");
  }
  if (method == 1 || method == 2) {
    gmsh::optimize("HighOrder");
  }
  if (method == 4) {
    gmsh::optimize("HighOrderFastCurving");
  }
}

void generate(const MeshArguments& arguments, meshgrow_field* field) {
  Progress progress;
  if (field == nullptr) {
    progress.tell("No size function is given: Gmsh's own sizes rule.");
    gmsh::generate(arguments.gmsh.dim);
    return;
  }
  show_progress(field, progress);
  const int failed = meshgrow_field_generate(field, arguments.gmsh.dim, arguments.remesh ? 1 : 0);
  const std::string problem = failed != 0 ? meshgrow_last_error() : "";
  meshgrow_field_set_progress(field, nullptr, nullptr);
  if (failed != 0) {
    throw Error(problem);
  }
  optimize_high_order();
}

/// Prints and writes the report. Returns whether the mesh is acceptable.
bool report(const MeshArguments& arguments, const std::vector<FailCondition>& conditions,
            const fs::path& output, meshgrow_field* field) {
  const int meshed =
      meshed_dimension(arguments.gmsh.task == GmshCommandLine::Task::mesh ? arguments.gmsh.dim : 3);
  const bool is_asked_for = !conditions.empty() || !arguments.report.empty();
  if (meshed < 2 && !is_asked_for) {
    return true;
  }
  const ReportedPart part{std::max(meshed, 2), {}, field};
  nlohmann::json row = {
      {"name", output.filename().string()},
      {"report",
       nlohmann::json::parse(take_text(meshgrow_report_json(part.dim, nullptr, 0, field)))}};
  std::cout << '\n'
            << take_text(meshgrow_report_table(json_text(nlohmann::json::array({row})).c_str()))
            << std::flush;
  const bool acceptable = check_report(conditions, part, row);
  if (!arguments.report.empty()) {
    write_text(arguments.report, json_text(nlohmann::json::array({row}), 2) + "\n");
  }
  return acceptable;
}

void print_model_functions(const std::string& model) {
  for (const OnelabFunction& function : onelab_functions()) {
    std::cout << "Size function '" << function.name << "' of " << model << ": " << function.text
              << '\n';
  }
}

void mesh(const MeshArguments& arguments) {
  using Task = GmshCommandLine::Task;
  const std::vector<std::string> texts = size_function_texts(arguments.field);
  const std::vector<FailCondition> conditions = parse_fail_conditions(arguments.fail_if);
  const GmshSession session(arguments.gmsh.options);
  end_when_interrupted("mesh");  // Gmsh, too, sets what signals do
  std::cout << "Reading " << arguments.models.front() << std::endl;
  open_model(arguments.models);
  if (arguments.gmsh.task == Task::parse) {
    return;
  }
  print_model_functions(arguments.models.front());
  const FieldPointer field = has_size_functions(arguments.field, texts)
                                 ? make_field(arguments.field, texts)
                                 : FieldPointer();
  if (arguments.plan) {
    std::cout << (field ? take_text(meshgrow_field_plan(field.get(), arguments.gmsh.dim))
                        : "No size function is given: Gmsh's own sizes and order rule.\n")
              << std::flush;
    return;
  }
  const fs::path output = output_of(arguments);
  check_writable(output, "choose another output with -o");
  if (!arguments.report.empty()) {
    check_writable(arguments.report, "choose another file with --report");
  }
  if (arguments.gmsh.task == Task::mesh) {
    generate(arguments, field.get());
  }
  const auto partitions = static_cast<int>(gmsh::option("Mesh.NbPartitions"));
  if (arguments.gmsh.part && partitions > 1) {
    gmsh::partition(partitions);
  }
  write_mesh(output);
  tell_that_it_is_written();
  if (field) {
    std::cout << '\n' << take_text(meshgrow_field_summary(field.get()));
  }
  const bool acceptable = report(arguments, conditions, output, field.get());
  std::cout << "\nWrote " << output.string() << ". To look at it: gmsh "
            << shell_quoted(output.string()) << std::endl;
  if (!acceptable) {
    throw CLI::RuntimeError(ExitCode::work_failed);
  }
}

}  // namespace

void add_mesh_command(CLI::App& program, std::vector<std::string>& program_arguments) {
  const auto arguments = std::make_shared<MeshArguments>();
  CLI::App& command =
      *program.add_subcommand("mesh", "Mesh a model, sources of size functions first");
  command
      .add_option("models", arguments->models,
                  "What Gmsh can open: .geo, .step, .brep, .msh …; more than one are merged")
      ->required();
  command.add_option("-o,--output", arguments->output,
                     "Mesh file; its ending tells the format (default: the model's name, .msh)");
  command.add_flag("--plan", arguments->plan, "Print the passes and mesh nothing");
  command.add_flag("--remesh", arguments->remesh,
                   "Mesh again all that is no source of a mesh size function");
  command.add_option("--report", arguments->report,
                     "Also write the report of the mesh to this file, as JSON");
  add_fail_option(command, arguments->fail_if);
  add_field_options(command, arguments->field);
  command.footer(
      "Example:\n"
      "  meshgrow mesh model.geo -3 -o model.msh --report report.json --fail-if 'ratio_p99 > 1.4'\n"
      "A .geo may define size functions itself:\n"
      "  DefineConstant[ sf = {\"mesh source Surface{7} attach Volume{2} growth 1.2 limit 2\",\n"
      "                        Name \"Size functions/inner\", ReadOnly 1} ];\n"
      "Without any size function the mesh is the one that gmsh makes. The mesh is written before\n"
      "its report is checked.\n" +
      gmsh_options_help() + "\n" + exit_codes_help);
  command.callback([arguments] { mesh(*arguments); });
  if (!program_arguments.empty() && program_arguments.front() == command.get_name()) {
    arguments->gmsh = take_gmsh_options(command, program_arguments);
  }
}

}  // namespace meshgrow::cli
