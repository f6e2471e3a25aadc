#ifndef MESHGROW_CLI_MESH_COMMAND_H
#define MESHGROW_CLI_MESH_COMMAND_H

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace meshgrow::cli {

/// `meshgrow mesh`, or with --plan only what it would do. `arguments` are the program's: if they
/// call this command, gmsh's own options are taken out of them. Runs while the rest is parsed;
/// throws Error. The output file is replaced only when the new mesh is complete.
void add_mesh_command(CLI::App& program, std::vector<std::string>& arguments);

}  // namespace meshgrow::cli

#endif
