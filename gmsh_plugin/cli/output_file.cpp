#include "output_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include "error.h"
#include "gmsh_api.h"

namespace meshgrow::cli {

namespace fs = std::filesystem;

namespace {

/// Where a mesh is written until it is complete; the ending stays, since it tells Gmsh the format.
fs::path unfinished_path(const fs::path& output) {
  fs::path path = output;
  path.replace_filename("." + output.stem().string() + ".unfinished" + output.extension().string());
  return path;
}

}  // namespace

void check_writable(const fs::path& output) {
  const fs::path unfinished = unfinished_path(output);
  std::ofstream file(unfinished);
  const bool blocked = fs::is_directory(output);
  if (!file || blocked) {
    const std::string reason = blocked ? "it is a directory" : std::strerror(errno);
    throw Error("Cannot write " + output.string() + " (" + reason +
                "): choose another output with -o.");
  }
  file.close();
  fs::remove(unfinished);
}

void write_mesh(const fs::path& output) {
  const fs::path unfinished = unfinished_path(output);
  std::string problem;
  try {
    gmsh::write(unfinished.string());
  } catch (const Error& error) {
    problem = error.what();
  }
  std::error_code failed;
  if (!problem.empty() || !fs::exists(unfinished) || fs::file_size(unfinished, failed) == 0) {
    fs::remove(unfinished, failed);
    throw Error("Gmsh did not write " + output.string() +
                (problem.empty() ? "" : " (" + problem + ")") +
                ": choose an ending that it knows, such as .msh.");
  }
  fs::rename(unfinished, output);
}

}  // namespace meshgrow::cli
