#include "gmsh_session.h"

#include "gmsh_api.h"

namespace meshgrow::cli {

GmshSession::GmshSession(int verbosity) {
  gmsh::initialize({"meshgrow"});
  gmsh::set_option("General.Terminal", 1.0);
  gmsh::set_option("General.Verbosity", verbosity);
}

GmshSession::~GmshSession() {
  try {
    gmsh::finalize();
  } catch (...) {
    // Nothing is left to lose at the end of the program.
  }
}

}  // namespace meshgrow::cli
