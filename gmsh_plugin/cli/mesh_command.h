#ifndef MESHGROW_CLI_MESH_COMMAND_H
#define MESHGROW_CLI_MESH_COMMAND_H

#include <CLI/App.hpp>

namespace meshgrow::cli {

/// `meshgrow mesh`, or with --plan only what it would do. Runs while the program's arguments are
/// parsed; throws Error. The output file is replaced only when the new mesh is complete.
void add_mesh_command(CLI::App& program);

}  // namespace meshgrow::cli

#endif
