#include "gmsh_library.h"

#include <dlfcn.h>
#include <link.h>

#include <cstdlib>
#include <vector>

namespace meshgrow {

namespace {

/// Path of a libgmsh that some other module has loaded, perhaps with local visibility (as Python
/// does, so that a global symbol look-up does not see it). Empty if there is none.
std::string loaded_library_path() {
  std::string path;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* result) {
        const std::string name = info->dlpi_name;
        const std::string file = name.substr(name.find_last_of('/') + 1);
        if (file.rfind("libgmsh.", 0) == 0 || file.rfind("libgmsh-", 0) == 0) {
          *static_cast<std::string*>(result) = name;
          return 1;
        }
        return 0;
      },
      &path);
  return path;
}

std::vector<std::string> usual_names() {
  std::vector<std::string> names = {"libgmsh.so"};
  for (int minor = 40; minor >= 8; --minor) {
    names.push_back("libgmsh.so.4." + std::to_string(minor));
  }
  return names;
}

}  // namespace

GmshLibrary& GmshLibrary::instance() {
  static GmshLibrary library;
  return library;
}

GmshLibrary::GmshLibrary() {
  open();
  free_ = reinterpret_cast<void (*)(void*)>(dlsym(handle_, "gmshFree"));
}

void GmshLibrary::open() {
  if (dlsym(RTLD_DEFAULT, "gmshModelMeshGenerate") != nullptr) {
    handle_ = RTLD_DEFAULT;
    path_ = loaded_library_path();
    return;
  }
  path_ = loaded_library_path();
  if (!path_.empty()) {
    handle_ = dlopen(path_.c_str(), RTLD_LAZY | RTLD_NOLOAD);
    if (handle_ != nullptr) {
      return;
    }
  }
  const char* named = std::getenv("MESHGROW_GMSH_LIB");
  if (named != nullptr && *named != '\0') {
    path_ = named;
    handle_ = dlopen(named, RTLD_LAZY | RTLD_LOCAL);
    if (handle_ == nullptr) {
      throw Error(std::string("MESHGROW_GMSH_LIB does not name a libgmsh that can be loaded (") +
                  dlerror() + "): correct or unset it.");
    }
    return;
  }
  for (const std::string& name : usual_names()) {
    handle_ = dlopen(name.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (handle_ != nullptr) {
      const std::string found = loaded_library_path();
      path_ = found.empty() ? name : found;
      return;
    }
  }
  throw Error(
      "No libgmsh was found: install Gmsh's library (Debian: libgmsh-dev; PyPI: gmsh), or set "
      "MESHGROW_GMSH_LIB to its path.");
}

void* GmshLibrary::find_symbol(const char* name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  auto found = symbols_.find(name);
  if (found == symbols_.end()) {
    found = symbols_.emplace(name, dlsym(handle_, name)).first;
  }
  return found->second;
}

void* GmshLibrary::symbol(const char* name) {
  void* found = find_symbol(name);
  if (found == nullptr) {
    throw Error("The libgmsh in use (" + path_ + ") has no function " + name +
                ": Gmsh 4.8 or later is needed.");
  }
  return found;
}

bool GmshLibrary::has(const char* name) { return find_symbol(name) != nullptr; }

void GmshLibrary::free(void* memory) noexcept {
  if (memory != nullptr && free_ != nullptr) {
    free_(memory);
  }
}

std::string GmshLibrary::failure(const char* name) {
  std::string reason;
  char* message = nullptr;
  int failed = 0;
  if (has("gmshLoggerGetLastError")) {
    reinterpret_cast<void (*)(char**, int*)>(symbol("gmshLoggerGetLastError"))(&message, &failed);
    if (failed == 0 && message != nullptr) {
      reason = message;
      free(message);
    }
  }
  return std::string("Gmsh: ") + (reason.empty() ? "the call failed" : reason) + " (" + name + ")";
}

}  // namespace meshgrow
