#include "gmsh_session.h"

#include "gmsh_api.h"
#include "usage_error.h"

namespace meshgrow::cli {

namespace {

void finalize_quietly() {
  try {
    gmsh::finalize();
  } catch (...) {
    // Nothing is left to lose at the end of the program.
  }
}

}  // namespace

GmshSession::GmshSession(const std::vector<std::string>& options) {
  std::vector<std::string> arguments = {"meshgrow", "-v", "2"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  gmsh::initialize(arguments);
  const std::string problem = gmsh::last_error();
  if (!problem.empty()) {
    finalize_quietly();
    throw UsageError("Gmsh refuses its options (" + problem + "): correct them.");
  }
  // What gmsh's own program does with it since 4.9, and the library does not.
  for (std::size_t i = 0; i + 2 < options.size() && !gmsh::is_4_8(); ++i) {
    if (options[i] == "-setstring") {
      gmsh::set_onelab_string(options[i + 1], options[i + 2]);
    }
  }
}

GmshSession::~GmshSession() { finalize_quietly(); }

std::string found_gmsh() {
  const GmshSession session({"-v", "0"});
  return gmsh::version_text() + " (" + gmsh::library_path() + ")";
}

}  // namespace meshgrow::cli
