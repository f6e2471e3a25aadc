#include "model_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "field_file.h"
#include "gmsh_api.h"
#include "onelab_functions.h"
#include "usage_error.h"

namespace meshgrow::cli {

namespace {

void check_readable(const std::string& file) {
  if (!std::ifstream(file)) {
    throw UsageError("Cannot read " + file + " (" + std::strerror(errno) +
                     "): give a file that Gmsh can open.");
  }
  if (std::filesystem::is_directory(file)) {
    throw UsageError(file + " is a directory: give a file that Gmsh can open.");
  }
  if (is_field_file(file)) {
    throw UsageError(file +
                     " is a saved size field: give a model; report takes it as --sizes, and field, "
                     "probe and serve as it is.");
  }
}

}  // namespace

void open_model(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    check_readable(file);
  }
  forget_onelab_functions();
  for (const std::string& file : files) {
    std::string problem;
    try {
      if (&file == &files.front()) {
        gmsh::open(file);
      } else {
        gmsh::merge(file);
      }
      problem = gmsh::last_error();
    } catch (const Error& error) {
      problem = error.what();
    }
    if (!problem.empty()) {
      throw UsageError("Gmsh cannot read " + file + " (" + problem + "): correct the file.");
    }
  }
  if (gmsh::entities().empty()) {
    throw UsageError(files.front() +
                     " holds no geometry and no mesh: give a model that Gmsh can read.");
  }
  warn_of_unusable_onelab_functions();
}

void open_model(const std::string& file) { open_model(std::vector<std::string>{file}); }

}  // namespace meshgrow::cli
