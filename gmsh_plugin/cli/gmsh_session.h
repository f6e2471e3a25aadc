#ifndef MESHGROW_CLI_GMSH_SESSION_H
#define MESHGROW_CLI_GMSH_SESSION_H

namespace meshgrow::cli {

/// Gmsh for the life of this object.
class GmshSession {
 public:
  /// `verbosity`: Gmsh's, 0 to 99. Throws Error if there is no Gmsh.
  explicit GmshSession(int verbosity);
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;
};

}  // namespace meshgrow::cli

#endif
