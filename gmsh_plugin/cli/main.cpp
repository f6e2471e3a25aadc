// The program `meshgrow`: meshes models with size functions and reports on meshes.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "commands.h"
#include "meshgrow.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Meshes Gmsh models with sizes that grow from what is meshed already.\n"
      "A size function is one line of text, for example\n"
      "  mesh  source Surface{7} attach Volume{2} growth 1.2 limit 2\n"
      "  fixed source Curve{1,4} attach Physical Surface{\"inlet\"} size 0.1 growth 1.2 limit 2\n"
      "  curvature source Volume{1} attach Volume{1} angle 18 growth 1.2 limit 2\n"
      "  proximity source Volume{1} attach Volume{1} cells 3 growth 1.2 limit 2",
      "meshgrow");
  app.set_version_flag("--version", std::string("meshgrow ") + meshgrow_version());
  app.require_subcommand(1);

  meshgrow::cli::FieldArguments field_arguments;
  const auto add_field_options = [&field_arguments](CLI::App* command) {
    command
        ->add_option("--size-function", field_arguments.size_functions,
                     "A size function, one line of text such as 'mesh source Surface{7} attach "
                     "Volume{2} growth 1.2 limit 2'; may be given several times")
        ->allow_extra_args(false);
    command->add_option("--size-functions", field_arguments.file,
                        "A file of size functions, one a line; # begins a comment");
    command
        ->add_option("--defaults", field_arguments.defaults_limit,
                     "Curvature (18 degrees) and proximity (3 cells per gap) of everything, "
                     "growth 1.2, up to this size")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--tolerance", field_arguments.tolerance,
                     "Relative tolerance of the background grid")
        ->capture_default_str();
    command
        ->add_option("--evaluator", field_arguments.evaluator,
                     "Who answers sizes: exact (a tree of facets), grid (a background grid) or "
                     "auto (a grid where it pays)")
        ->check(CLI::IsMember({"auto", "grid", "exact"}))
        ->capture_default_str();
    command->add_flag("--strict", field_arguments.strict,
                      "A source without a mesh is an error, not a warning");
    command->add_flag("--calibrate", field_arguments.calibrate,
                      "Correct sizes by measured factors: Gmsh's edges get the length asked for");
  };

  meshgrow::cli::MeshArguments mesh_arguments;
  CLI::App* mesh = app.add_subcommand("mesh", "Mesh a model, sources of size functions first");
  mesh->add_option("model", mesh_arguments.model, "What Gmsh can open: .geo, .step, .brep, .msh …")
      ->required();
  mesh->add_flag("-1", mesh_arguments.dim_1, "Mesh curves");
  mesh->add_flag("-2", mesh_arguments.dim_2, "Mesh curves and surfaces");
  mesh->add_flag("-3", mesh_arguments.dim_3, "Mesh all (the default)");
  mesh->add_option("-o,--output", mesh_arguments.output,
                   "Mesh file; its ending tells the format (default: the model's name, .msh)");
  mesh->add_flag("--plan", mesh_arguments.plan, "Print the passes and mesh nothing");
  mesh->add_flag("--remesh", mesh_arguments.remesh,
                 "Mesh again all that is no source of a mesh size function");
  mesh->add_option("-v", mesh_arguments.verbosity, "Gmsh's verbosity, 0 to 99")
      ->capture_default_str();
  add_field_options(mesh);

  meshgrow::cli::ReportArguments report_arguments;
  CLI::App* report = app.add_subcommand("report", "Gradation and quality of meshes, as a table");
  report->add_option("meshes", report_arguments.meshes, "Mesh files")->required();
  report->add_option("--dim", report_arguments.dim, "2 or 3")
      ->capture_default_str()
      ->check(CLI::Range(2, 3));
  report->add_option("--entities", report_arguments.entities,
                     "Only these, for example 'Volume{2,3}'");
  report->add_flag("--json", report_arguments.json, "JSON instead of a table");
  add_field_options(report);

  CLI11_PARSE(app, argc, argv);
  try {
    if (*mesh) {
      meshgrow::cli::mesh(mesh_arguments, field_arguments);
    } else {
      meshgrow::cli::report(report_arguments, field_arguments);
    }
  } catch (const std::exception& error) {
    std::cout.flush();
    std::cerr << "meshgrow: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
