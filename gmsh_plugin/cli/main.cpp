// The program `meshgrow`: meshes models with size functions and reports on meshes.

#include <CLI/CLI.hpp>
#include <iostream>

#include "field_command.h"
#include "mesh_command.h"
#include "meshgrow.h"
#include "report_command.h"

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
  meshgrow::cli::add_mesh_command(app);
  meshgrow::cli::add_report_command(app);
  meshgrow::cli::add_field_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    std::cout.flush();
    std::cerr << "meshgrow: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
