#include "model_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "error.h"
#include "gmsh_api.h"

namespace meshgrow::cli {

void open_model(const std::string& file) {
  if (!std::ifstream(file)) {
    throw Error("Cannot read " + file + " (" + std::strerror(errno) +
                "): give a file that Gmsh can open.");
  }
  if (std::filesystem::is_directory(file)) {
    throw Error(file + " is a directory: give a file that Gmsh can open.");
  }
  std::string problem;
  try {
    gmsh::open(file);
    problem = gmsh::last_error();
  } catch (const Error& error) {
    problem = error.what();
  }
  if (!problem.empty()) {
    throw Error("Gmsh cannot read " + file + " (" + problem + "): correct the file.");
  }
  if (gmsh::entities().empty()) {
    throw Error(file + " holds no geometry and no mesh: give a model that Gmsh can read.");
  }
}

}  // namespace meshgrow::cli
