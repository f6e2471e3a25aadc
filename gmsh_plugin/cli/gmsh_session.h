#ifndef MESHGROW_CLI_GMSH_SESSION_H
#define MESHGROW_CLI_GMSH_SESSION_H

#include <string>
#include <vector>

namespace meshgrow::cli {

/// Gmsh for the life of this object, with its messages on the terminal: warnings and errors only
/// unless the options say more.
class GmshSession {
 public:
  /// `options`: gmsh's own, as on its command line. Throws Error if there is no Gmsh, UsageError if
  /// it refuses one of the options.
  explicit GmshSession(const std::vector<std::string>& options = {});
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;
};

/// "4.15.2 (/usr/lib/libgmsh.so.4.15)" of the Gmsh that is found. Throws Error if there is none.
std::string found_gmsh();

}  // namespace meshgrow::cli

#endif
