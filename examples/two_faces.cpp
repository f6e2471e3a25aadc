// Two faces side by side, as two_faces.py with a mesh size function: Figures 10 and 11 of the
// paper.
//
//     two_faces [mesh.msh] [edge|vertex] [triangles|quads|mapped]
//
// The left face is mapped, so that the common edge gets as many elements as the left edge; the
// right face grows from the mesh that is there.

#ifdef GMSH_OVER_C  // Gmsh's C++ functions may be of another C++ ABI
#include <gmsh.h_cwrap>
#else
#include <gmsh.h>
#endif

#include <exception>
#include <iostream>
#include <meshgrow.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

constexpr double growth_rate = 1.2;
constexpr double left_limit = 0.12;
constexpr double size_limit = 0.5;  // of the right face and of Gmsh
constexpr double height = 2;
constexpr double right_width = 4;

struct TwoFaces {
  std::pair<int, int> left, right, common, source;
};

/// Two rectangles.
TwoFaces build_geometry(bool from_vertex, double left_width, const std::string& right_face) {
  namespace geo = gmsh::model::geo;
  std::vector<int> points;
  for (const double x : {0.0, left_width, left_width + right_width}) {
    for (const double y : {0.0, height}) {
      points.push_back(geo::addPoint(x, y, 0));
    }
  }
  std::vector<int> upright, below, above;
  for (const int i : {0, 2, 4}) {
    upright.push_back(geo::addLine(points[i], points[i + 1]));
  }
  for (const int i : {0, 2}) {
    below.push_back(geo::addLine(points[i], points[i + 2]));
  }
  for (const int i : {1, 3}) {
    above.push_back(geo::addLine(points[i], points[i + 2]));
  }
  std::vector<int> faces;
  for (const int i : {0, 1}) {
    const int loop = geo::addCurveLoop({below[i], upright[i + 1], -above[i], -upright[i]});
    faces.push_back(geo::addPlaneSurface({loop}));
  }
  geo::synchronize();
  const int left = faces[0], right = faces[1];
  gmsh::model::mesh::setTransfiniteSurface(left);
  gmsh::model::mesh::setRecombine(2, left);
  if (right_face == "mapped") {
    gmsh::model::mesh::setTransfiniteSurface(right);
  }
  if (right_face != "triangles") {
    gmsh::model::mesh::setRecombine(2, right);
  }
  const auto source = from_vertex ? std::make_pair(0, points[1]) : std::make_pair(1, upright[0]);
  return {{2, left}, {2, right}, {1, upright[1]}, source};
}

void run(const std::string& output, const std::string& from, const std::string& right_face) {
  if ((from != "edge" && from != "vertex") ||
      (right_face != "triangles" && right_face != "quads" && right_face != "mapped")) {
    throw std::invalid_argument("use: two_faces [mesh.msh] [edge|vertex] [triangles|quads|mapped]");
  }
  const bool from_vertex = from == "vertex";
  const double size = from_vertex ? 0.05 : 0.1;
  const double left_width = from_vertex ? 1.0 : 0.8;
  gmsh::option::setNumber("Mesh.MeshSizeMax", size_limit);
  const TwoFaces model = build_geometry(from_vertex, left_width, right_face);

  meshgrow::SizeField field;
  field.add_fixed({model.source}, {model.left}, size, growth_rate, left_limit);
  field.add_mesh({model.common}, {model.right}, growth_rate, size_limit);
  std::cout << field.plan(2);
  field.generate(2);
  std::cout << meshgrow::report_table({{"right face", meshgrow::report(2, {model.right}, field)}});
  gmsh::write(output);
}

}  // namespace

int main(int argc, char** argv) try {
  const std::vector<std::string> words(argv + 1, argv + argc);
  gmsh::initialize();
  gmsh::option::setNumber("General.Verbosity", 2);
  run(!words.empty() ? words[0] : "two_faces.msh", words.size() > 1 ? words[1] : "edge",
      words.size() > 2 ? words[2] : "triangles");
  gmsh::finalize();
  return 0;
} catch (const std::exception& error) {
  std::cerr << "error: " << error.what() << '\n';
  return 1;
}
