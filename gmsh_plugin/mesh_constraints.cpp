#include "mesh_constraints.h"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "error.h"
#include "gmsh_api.h"
#include "gmsh_state.h"
#include "restore.h"
#include "temporary_directory.h"
#include "text_stream.h"
#include "whole_file.h"

namespace meshgrow {

namespace {

/// A point that is no OpenCASCADE one, for the life of this object. Without one, newer versions of
/// Gmsh write the OpenCASCADE geometry alone and no constraints.
class ForeignPoint {
 public:
  ForeignPoint() : point_(gmsh::add_discrete_point()) {}
  ~ForeignPoint() {
    restore([this] { gmsh::remove_entity(point_); });
  }
  ForeignPoint(const ForeignPoint&) = delete;
  ForeignPoint& operator=(const ForeignPoint&) = delete;

 private:
  Entity point_;
};

std::string unrolled_geo() {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "model.geo_unrolled").string();
  GmshState state;
  // Surfaces that it cannot write are no concern here, and none of the user's.
  state.set_option("General.Verbosity", 0.0);
  state.set_option("General.AbortOnError", 0.0);
  state.set_option("Print.GeoOnlyPhysicals", 0.0);
  {
    const ForeignPoint point;
    gmsh::write(file);
  }
  if (!has_room_behind(file)) {
    throw Error(
        "The constraints of Gmsh's model cannot be read, since a temporary file could not be "
        "written: make room, or set TMPDIR to another directory.");
  }
  std::ifstream stream(file);
  TextStream text;
  text << stream.rdbuf();
  return text.str();
}

/// The integers between the next pair of braces; moves behind it.
std::vector<int> integers_in_braces(const std::string& line, std::size_t& at) {
  std::vector<int> result;
  const std::size_t open = line.find('{', at);
  const std::size_t close = line.find('}', at);
  if (open == std::string::npos || close == std::string::npos) {
    at = line.size();
    return result;
  }
  std::istringstream list(line.substr(open + 1, close - open - 1));
  for (std::string number; std::getline(list, number, ',');) {
    result.push_back(std::atoi(number.c_str()));
  }
  at = close + 1;
  return result;
}

bool begins_with(const std::string& line, const std::string& words) {
  return line.compare(0, words.size(), words) == 0;
}

}  // namespace

MeshConstraints parse_unrolled_geo(const std::string& text) {
  MeshConstraints result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::size_t at = 0;
    if (begins_with(line, "Transfinite Line ") || begins_with(line, "Transfinite Curve ")) {
      const std::vector<int> tags = integers_in_braces(line, at);
      const std::size_t equals = line.find('=', at);
      if (tags.size() == 1 && equals != std::string::npos) {
        const int points = std::atoi(line.c_str() + equals + 1);
        result.prescribed_intervals[{1, std::abs(tags[0])}] = std::max(points - 1, 1);
      }
    } else if (begins_with(line, "Transfinite Surface ")) {
      const std::vector<int> tags = integers_in_braces(line, at);
      if (tags.size() == 1) {
        result.mapped_surfaces.push_back({{2, tags[0]}, {}, integers_in_braces(line, at)});
      }
    } else if (begins_with(line, "Transfinite Volume ")) {
      for (const int tag : integers_in_braces(line, at)) {
        result.mapped_volumes.push_back({3, tag});
      }
    } else if (begins_with(line, "Recombine Surface ")) {
      for (const int tag : integers_in_braces(line, at)) {
        result.recombined_surfaces.insert({2, tag});
      }
    }
  }
  return result;
}

MeshConstraints read_mesh_constraints(const Topology& topology) {
  if (topology.entities(2).empty()) {
    return {};
  }
  MeshConstraints result = parse_unrolled_geo(unrolled_geo());
  for (MappedSurface& mapped : result.mapped_surfaces) {
    if (topology.contains(mapped.surface)) {
      mapped.boundary = gmsh::boundary(mapped.surface);
    }
  }
  return result;
}

}  // namespace meshgrow
