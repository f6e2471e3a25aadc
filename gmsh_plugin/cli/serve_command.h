#ifndef MESHGROW_CLI_SERVE_COMMAND_H
#define MESHGROW_CLI_SERVE_COMMAND_H

#include <CLI/App.hpp>

namespace meshgrow::cli {

/// `meshgrow serve`: answers stock Gmsh's field ExternalProcess on standard input and output
/// (size_server.h) until it is told to end. Nothing but answers goes to standard output, whoever
/// prints in this process. Runs while the program's arguments are parsed.
void add_serve_command(CLI::App& program);

/// Answers all requests by "no size", for who cannot serve for a reason that was told.
void serve_nothing();

}  // namespace meshgrow::cli

#endif
