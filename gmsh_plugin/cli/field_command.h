#ifndef MESHGROW_CLI_FIELD_COMMAND_H
#define MESHGROW_CLI_FIELD_COMMAND_H

#include <CLI/App.hpp>

namespace meshgrow::cli {

/// `meshgrow field`: writes the field of a model into a file, to look at or to use elsewhere. Runs
/// while the program's arguments are parsed; throws Error. The output file is replaced only when
/// the new one is complete.
void add_field_command(CLI::App& program);

}  // namespace meshgrow::cli

#endif
