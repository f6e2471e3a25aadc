// Gmsh's meshers, what works on whole meshes, and the size callback.

#include <algorithm>

#include "changed_option.h"
#include "gmsh_api.h"
#include "gmsh_memory.h"

namespace meshgrow::gmsh {

void generate(int dim) {
  constexpr const char* abort_on_error = "General.AbortOnError";
  const double users = option(abort_on_error);
  const std::string told_before = last_error();
  {
    // Where an error is thrown (2, the default), Gmsh stays locked and meshes nothing more in the
    // session, and 4.8 throws it out of parallel loops, which ends the process. With 1 it stops
    // meshing and returns.
    const ChangedOption no_throw(abort_on_error, std::min(users, 1.0));
    library().call("gmshModelMeshGenerate", dim);
  }
  const std::string error = last_error();
  if (users > 0.0 && !error.empty()) {
    throw Error("Gmsh: " + error +
                (error == told_before
                     ? " (as before this pass; if that error has left Gmsh locked, call "
                       "gmsh.finalize() and gmsh.initialize())"
                     : ""));
  }
}

void set_order(int order) { library().call("gmshModelMeshSetOrder", order); }

std::string last_error() {
  GmshString message;
  library().call("gmshLoggerGetLastError", message.data());
  return message.copy();
}

void optimize(const std::string& method) {
  const int* everything = nullptr;
  library().call("gmshModelMeshOptimize", method.c_str(), 0, 1, everything, std::size_t{0});
}

void partition(int count) {
  // Newer versions take prescribed partitions of elements as well.
  if (is_4_8()) {
    library().call("gmshModelMeshPartition", count);
  } else {
    const std::size_t* no_elements = nullptr;
    const int* no_partitions = nullptr;
    library().call("gmshModelMeshPartition", count, no_elements, std::size_t{0}, no_partitions,
                   std::size_t{0});
  }
}

void set_size_callback(SizeCallback48 until_48, SizeCallback49 since_49, void* data) {
  if (is_4_8()) {
    library().call("gmshModelMeshSetSizeCallback", until_48, data);
  } else {
    library().call("gmshModelMeshSetSizeCallback", since_49, data);
  }
}

void remove_size_callback() { library().call("gmshModelMeshRemoveSizeCallback"); }

}  // namespace meshgrow::gmsh
