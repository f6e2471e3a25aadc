#ifndef MESHGROW_CLI_REPORT_COMMAND_H
#define MESHGROW_CLI_REPORT_COMMAND_H

#include <CLI/App.hpp>

namespace meshgrow::cli {

/// `meshgrow report`. Runs while the program's arguments are parsed; throws Error.
void add_report_command(CLI::App& program);

}  // namespace meshgrow::cli

#endif
