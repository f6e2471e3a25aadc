#include "temporary_directory.h"

#include <cstdlib>
#include <string>

#include "error.h"

namespace meshgrow {

TemporaryDirectory::TemporaryDirectory() {
  std::error_code failed;
  std::string name = (std::filesystem::temp_directory_path(failed) / "meshgrow-XXXXXX").string();
  if (failed || ::mkdtemp(name.data()) == nullptr) {
    throw Error(
        "No temporary file can be written, which is needed to read constraints of Gmsh's model and "
        "to set some: set TMPDIR to a writable directory.");
  }
  path_ = name;
}

TemporaryDirectory::~TemporaryDirectory() {
  for (int attempt = 0; attempt < 2; ++attempt) {
    try {
      std::error_code ignored;
      std::filesystem::remove_all(path_, ignored);
      return;
    } catch (...) {
      // There was no memory, and there may be some now.
    }
  }
}

}  // namespace meshgrow
