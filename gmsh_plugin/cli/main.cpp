// The program `meshgrow`: meshes models with size functions and reports on meshes.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "field_command.h"
#include "gmsh_session.h"
#include "mesh_command.h"
#include "meshgrow.h"
#include "probe_command.h"
#include "report_command.h"
#include "serve_command.h"
#include "usage_error.h"

namespace {

std::string version() {
  const std::string own = std::string("meshgrow ") + meshgrow_version();
  try {
    return own + " with Gmsh " + meshgrow::cli::found_gmsh();
  } catch (const std::exception& error) {
    return own + " without Gmsh (" + error.what() + ")";
  }
}

int fail(const std::exception& error, meshgrow::cli::ExitCode code) {
  std::cout.flush();
  std::cerr << "meshgrow: " << error.what() << '\n';
  return code;
}

int run(int argc, char** argv) {
  CLI::App app(
      "Meshes Gmsh models with sizes that grow from what is meshed already.\n"
      "A size function is one line of text, for example\n"
      "  mesh  source Surface{7} attach Volume{2} growth 1.2 limit 2\n"
      "  fixed source Curve{1,4} attach Physical Surface{\"inlet\"} size 0.1 growth 1.2 limit 2\n"
      "  curvature source Volume{1} attach Volume{1} angle 18 growth 1.2 limit 2\n"
      "  proximity source Volume{1} attach Volume{1} cells 3 growth 1.2 limit 2",
      "meshgrow");
  app.set_version_flag("--version", version);
  app.require_subcommand(1);
  app.footer(meshgrow::cli::exit_codes_help);
  std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    meshgrow::cli::add_mesh_command(app, arguments);
    meshgrow::cli::add_report_command(app);
    meshgrow::cli::add_field_command(app);
    meshgrow::cli::add_probe_command(app);
    meshgrow::cli::add_serve_command(app);
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
    app.parse(std::move(arguments));
  } catch (const CLI::RuntimeError& error) {
    return error.get_exit_code();
  } catch (const CLI::ParseError& error) {
    if (app.exit(error) == 0) {
      return meshgrow::cli::done;
    }
    if (app.got_subcommand("serve")) {
      meshgrow::cli::serve_nothing();  // Gmsh waits for answers all the same
    }
    return meshgrow::cli::wrong_use;
  } catch (const meshgrow::cli::UsageError& error) {
    return fail(error, meshgrow::cli::wrong_use);
  } catch (const std::exception& error) {
    return fail(error, meshgrow::cli::work_failed);
  }
  return meshgrow::cli::done;
}

}  // namespace

int main(int argc, char** argv) try {
  return run(argc, argv);
} catch (const std::exception& error) {
  return fail(error, meshgrow::cli::work_failed);
}
