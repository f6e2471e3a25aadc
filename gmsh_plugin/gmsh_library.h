#ifndef MESHGROW_GMSH_LIBRARY_H
#define MESHGROW_GMSH_LIBRARY_H

#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "error.h"

namespace meshgrow {

/// The libgmsh of this process, found at run time (DESIGN.md, section 4): the one that is loaded
/// already, else the file named by the environment variable MESHGROW_GMSH_LIB, else the usual
/// names.
///
/// Only functions of Gmsh's C API are looked up; they are the same for every C++ ABI.
class GmshLibrary {
 public:
  /// Finds the library on first use and keeps it for the life of the process. Throws Error with the
  /// remedy if there is none. Thread-safe.
  static GmshLibrary& instance();

  /// Calls the C function `name` with the arguments and Gmsh's trailing error flag. The argument
  /// types must be exactly those of the C function. Throws Error with Gmsh's last logged message.
  template <typename... Arguments>
  void call(const char* name, Arguments... arguments) {
    int failed = 0;
    reinterpret_cast<void (*)(Arguments..., int*)>(symbol(name))(arguments..., &failed);
    if (failed != 0) {
      throw Error(failure(name));
    }
  }

  /// The same for a function that returns an int.
  template <typename... Arguments>
  int call_int(const char* name, Arguments... arguments) {
    int failed = 0;
    const int result =
        reinterpret_cast<int (*)(Arguments..., int*)>(symbol(name))(arguments..., &failed);
    if (failed != 0) {
      throw Error(failure(name));
    }
    return result;
  }

  /// Frees memory that Gmsh allocated. Throws nothing: destructors do this.
  void free(void* memory) noexcept;

  bool has(const char* name);
  const std::string& path() const { return path_; }

 private:
  GmshLibrary();
  void open();
  void* symbol(const char* name);
  void* find_symbol(const char* name);
  std::string failure(const char* name);

  void* handle_ = nullptr;
  void (*free_)(void*) = nullptr;
  std::string path_;
  std::mutex mutex_;
  std::map<std::string, void*, std::less<>> symbols_;  ///< looked up without memory
};

}  // namespace meshgrow

#endif
