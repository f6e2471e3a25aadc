#include "output_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>

#include "gmsh_api.h"
#include "unfinished_file.h"
#include "usage_error.h"
#include "whole_file.h"

namespace meshgrow::cli {

namespace fs = std::filesystem;

namespace {

constexpr int format_by_ending = 10;

}  // namespace

std::string ending_of_format() {
  // Gmsh's numbers of formats that hold meshes.
  static const std::map<int, std::string> endings = {
      {1, ".msh"},    {2, ".unv"},   {16, ".vtk"},  {19, ".wrl"}, {21, ".mail"},
      {27, ".stl"},   {28, ".p3d"},  {30, ".mesh"}, {31, ".bdf"}, {32, ".cgns"},
      {33, ".med"},   {34, ".diff"}, {38, ".ir3"},  {39, ".inp"}, {40, ".ply2"},
      {41, ".celum"}, {42, ".su2"},  {46, ".x3d"},  {47, ".dat"}, {49, ".neu"},
      {50, ".m"},     {51, ".key"},  {53, ".off"},  {55, ".rad"}, {57, ".obj"}};
  const int format = static_cast<int>(gmsh::option("Mesh.Format"));
  if (format == format_by_ending) {
    return "";
  }
  const auto found = endings.find(format);
  if (found == endings.end()) {
    throw UsageError("Mesh.Format " + std::to_string(format) +
                     " (option -format) holds no mesh: choose another, such as msh.");
  }
  return found->second;
}

void check_writable(const fs::path& output, const std::string& remedy) {
  std::string reason = reason_against_file(output.string());
  if (reason.empty()) {
    const UnfinishedFile unfinished(output, output.extension().string());
    errno = 0;
    if (!std::ofstream(unfinished.path())) {
      reason = std::strerror(errno);
    }
  }
  if (!reason.empty()) {
    throw UsageError("Cannot write " + output.string() + " (" + reason + "): " + remedy + ".");
  }
}

void write_mesh(const fs::path& output) {
  const std::string ending = ending_of_format();
  UnfinishedFile unfinished(output, ending.empty() ? output.extension().string() : ending);
  std::string problem;
  try {
    gmsh::write(unfinished.path().string());
  } catch (const Error& error) {
    problem = error.what();
  }
  std::error_code failed;
  if (!problem.empty() || !fs::exists(unfinished.path()) ||
      fs::file_size(unfinished.path(), failed) == 0) {
    throw Error("Gmsh did not write " + output.string() +
                (problem.empty() ? "" : " (" + problem + ")") +
                ": choose an ending that it knows, such as .msh.");
  }
  if (!has_room_behind(unfinished.path().string())) {  // Gmsh does not look whether it could write
    throw Error("Gmsh could not write all of " + output.string() +
                ": make room, or choose another place.");
  }
  unfinished.finish();
}

void write_text(const fs::path& output, const std::string& text) {
  UnfinishedFile unfinished(output, output.extension().string());
  {
    std::ofstream file(unfinished.path());
    file << text;
    file.close();
    if (!file) {
      throw Error("Cannot write " + output.string() + " (" + std::strerror(errno) +
                  "): make room or choose another place.");
    }
  }
  unfinished.finish();
}

}  // namespace meshgrow::cli
