#ifndef MESHGROW_CLI_GMSH_COMMAND_LINE_H
#define MESHGROW_CLI_GMSH_COMMAND_LINE_H

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace meshgrow::cli {

/// What is there of gmsh's own command line, so that the word `gmsh` in a script can be replaced by
/// `meshgrow mesh`. Options mean exactly what they mean to gmsh, since Gmsh itself reads them.
struct GmshCommandLine {
  enum class Task { mesh, save, parse };
  Task task = Task::mesh;
  int dim = 3;        ///< the last of -1, -2 and -3
  bool part = false;  ///< -part: cut into partitions after meshing
  /// For Gmsh to read: options and their values, in order.
  std::vector<std::string> options;
};

/// Takes gmsh's options out of the program's arguments, whose first is the command's name.
/// `command` tells which of its own options have a value. Throws UsageError that names the option
/// if it is gmsh's but not taken, or lacks its value.
GmshCommandLine take_gmsh_options(const CLI::App& command, std::vector<std::string>& arguments);

/// Those that are taken, for the command's help.
std::string gmsh_options_help();

}  // namespace meshgrow::cli

#endif
