// The program `meshgrow`: meshes models with size functions and reports on meshes.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "c_guard.h"
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

int fail(const std::string& sentence, meshgrow::cli::ExitCode code) {
  std::cout.flush();
  std::cerr << "meshgrow: " << sentence << '\n';
  return code;
}

/// Throws UsageError if the first argument should be a command and is none.
void check_command(const CLI::App& app, const std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments.front().rfind('-', 0) == 0) {
    return;
  }
  std::string names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == arguments.front()) {
      return;
    }
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  throw meshgrow::cli::UsageError("There is no command \"" + arguments.front() +
                                  "\": give one of " + names + ".");
}

/// What CLI11 says, as our own sentences are.
int tell_wrong_use(const CLI::App& app, const CLI::ParseError& error) {
  std::string sentence = error.what();
  while (!sentence.empty() && (sentence.back() == '\n' || sentence.back() == '.')) {
    sentence.pop_back();
  }
  std::replace(sentence.begin(), sentence.end(), '\n', ' ');
  std::string command = app.get_name();
  for (const CLI::App* used : app.get_subcommands()) {
    command += " " + used->get_name();
  }
  return fail(sentence + ": see " + command + " --help.", meshgrow::cli::wrong_use);
}

int told_all(int code) {
  std::cout.flush();
  return std::cout || code != meshgrow::cli::done
             ? code
             : fail(
                   "Not all could be written to standard output: make room, or let it go to "
                   "another place.",
                   meshgrow::cli::work_failed);
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
    check_command(app, arguments);
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
    app.parse(std::move(arguments));
  } catch (const CLI::RuntimeError& error) {
    return error.get_exit_code();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // help, version
      app.exit(error);
      return told_all(meshgrow::cli::done);
    }
    const int code = tell_wrong_use(app, error);
    if (app.got_subcommand("serve")) {
      meshgrow::cli::serve_nothing();  // Gmsh waits for answers all the same
    }
    return code;
  } catch (const meshgrow::cli::UsageError& error) {
    return fail(error.what(), meshgrow::cli::wrong_use);
  } catch (const std::bad_alloc&) {
    return fail(meshgrow::c::out_of_memory, meshgrow::cli::work_failed);
  } catch (const std::exception& error) {
    return fail(error.what(), meshgrow::cli::work_failed);
  }
  return told_all(meshgrow::cli::done);
}

}  // namespace

int main(int argc, char** argv) try {
  return run(argc, argv);
} catch (const std::exception& error) {
  return fail(error.what(), meshgrow::cli::work_failed);
}
