#ifndef MESHGROW_CLI_PROBE_COMMAND_H
#define MESHGROW_CLI_PROBE_COMMAND_H

#include <CLI/App.hpp>

namespace meshgrow::cli {

/// `meshgrow probe`: tells which function and which facet of which entity decides the size at
/// points. Runs while the program's arguments are parsed; throws Error.
void add_probe_command(CLI::App& program);

}  // namespace meshgrow::cli

#endif
