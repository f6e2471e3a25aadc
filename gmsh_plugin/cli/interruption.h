#ifndef MESHGROW_CLI_INTERRUPTION_H
#define MESHGROW_CLI_INTERRUPTION_H

#include <string>

namespace meshgrow::cli {

/// From now on Ctrl-C (SIGINT) and SIGTERM end the program at once, also within Gmsh's algorithms,
/// with one sentence and 128 and the signal's number as exit code. Files are written beside their
/// place (unfinished_file.h), so that nothing is lost or half there. Signals that the caller of the
/// program ignores stay ignored. `what_is_written`, such as "mesh", is told; kept as it is.
void end_when_interrupted(const char* what_is_written);

/// The one file, or none if empty, that is removed then.
void remove_when_interrupted(const std::string& path);

/// What the sentence tells: the mesh, or what it is, was written before.
void tell_that_it_is_written();

}  // namespace meshgrow::cli

#endif
