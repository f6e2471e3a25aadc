// NACA 0012 with small elements at the nose, at the shock and at the tail (see airfoil.py).
//
//     airfoil airfoil.msh [six_fixed] [quads]
//
// First way: three curves, bunched, and one mesh size function. Second way (six_fixed): curves that
// are split where sizes shall be, and six fixed size functions.

#ifdef GMSH_OVER_C  // the newest from PyPI: its C++ functions may be of another C++ ABI
#include <gmsh.h_cwrap>
#else
#include <gmsh.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <iostream>
#include <meshgrow.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

namespace geo = gmsh::model::geo;

constexpr double growth_rate = 1.2;
constexpr double size_limit = 1.0;
constexpr double far = 4.0;      ///< radius of the air around the airfoil, in chords
constexpr double shock = 0.6;    ///< where it is on the upper side, in chords from the nose
constexpr double panel = 0.004;  ///< between points of the splines
constexpr int steps = 2000;      ///< along a curve, to measure it
constexpr double thickness = 0.12;
constexpr int frontal_delaunay = 6;

struct Place {
  double x;
  double y;
};

/// Where the upper (side = 1) or lower side (-1) is at x of the chord.
Place place(int side, double x) {
  const double half =
      5 * thickness *
      (0.2969 * std::sqrt(x) + x * (-0.1260 + x * (-0.3516 + x * (0.2843 - x * 0.1036))));
  return {x, side * half};
}

int add_point(int side, double x) {
  const Place at = place(side, x);
  return geo::addPoint(at.x, at.y, 0);
}

/// A point of the airfoil: x of the chord and its tag.
struct End {
  double x;
  int tag;
};

/// A spline of a side. Its points are equally far apart, as Gmsh bunches by the parameter of a
/// curve.
int add_spline(int side, const End& start, const End& end) {
  const double begin = std::acos(1 - 2 * start.x);
  const double finish = std::acos(1 - 2 * end.x);
  std::vector<Place> places;
  std::vector<double> walked;
  for (int i = 0; i <= steps; ++i) {
    places.push_back(place(side, 0.5 * (1 - std::cos(begin + i * (finish - begin) / steps))));
    double way = 0.0;
    if (i > 0) {
      const double dx = places[i].x - places[i - 1].x;
      const double dy = places[i].y - places[i - 1].y;
      way = walked.back() + std::sqrt(dx * dx + dy * dy);
    }
    walked.push_back(way);
  }
  const double count = std::ceil(walked.back() / panel);
  std::vector<int> points = {start.tag};
  for (int i = 1; i < steps; ++i) {
    const double here = static_cast<double>(points.size());
    if (walked[i] >= here * walked.back() / count && here < count) {
      points.push_back(geo::addPoint(places[i].x, places[i].y, 0));
    }
  }
  points.push_back(end.tag);
  return geo::addSpline(points);
}

/// Adds the splines of a side between points to `curves`.
void add_side(int side, const std::vector<End>& ends, std::vector<int>& curves) {
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    curves.push_back(add_spline(side, ends[i], ends[i + 1]));
  }
}

/// A disk with the airfoil cut out; returns its surface.
std::pair<int, int> add_air(const std::vector<int>& airfoil) {
  const int center = geo::addPoint(0.5, 0, 0);
  const std::array<int, 4> rim = {geo::addPoint(0.5 + far, 0, 0), geo::addPoint(0.5, far, 0),
                                  geo::addPoint(0.5 - far, 0, 0), geo::addPoint(0.5, -far, 0)};
  std::vector<int> arcs;
  arcs.reserve(rim.size());
  for (int i = 0; i < 4; ++i) {
    arcs.push_back(geo::addCircleArc(rim[i], center, rim[(i + 1) % 4]));
  }
  const int surface = geo::addPlaneSurface({geo::addCurveLoop(arcs), geo::addCurveLoop(airfoil)});
  geo::synchronize();
  return {2, surface};
}

struct Model {
  std::pair<int, int> air;
  meshgrow::SizeField field;
};

/// The first way, from the nose over the shock to the tail and back below.
Model build_bunched() {
  const End nose = {0.0, add_point(1, 0.0)};
  const End tail = {1.0, add_point(1, 1.0)};
  const End split = {shock, add_point(1, shock)};
  std::vector<int> curves;
  add_side(1, {nose, split, tail}, curves);
  add_side(-1, {tail, nose}, curves);
  geo::mesh::setTransfiniteCurve(curves[0], 32, "Bump", 0.22);
  geo::mesh::setTransfiniteCurve(curves[1], 27, "Bump", 0.3);
  geo::mesh::setTransfiniteCurve(curves[2], 40, "Bump", 0.15);
  const std::pair<int, int> air = add_air(curves);

  meshgrow::SizeField field;
  field.add_mesh({{1, curves[0]}, {1, curves[1]}, {1, curves[2]}}, {air}, growth_rate, size_limit);
  return {air, std::move(field)};
}

/// The second way: the curves of Figure 1 of the paper, ab (0) to fg (5) and hj (6) to la (9). a is
/// the nose; g and h are one point, as the tail is closed.
Model build_split() {
  std::vector<End> upper;
  for (const double x : {0.0, 0.01, 0.04, 0.578, 0.622, 0.98, 1.0}) {
    upper.push_back({x, add_point(1, x)});
  }
  std::vector<End> lower = {upper.back()};
  for (const double x : {0.98, 0.04, 0.01}) {
    lower.push_back({x, add_point(-1, x)});
  }
  lower.push_back(upper.front());
  std::vector<int> curves;
  add_side(1, upper, curves);
  add_side(-1, lower, curves);
  const std::pair<int, int> air = add_air(curves);

  meshgrow::SizeField field;
  field.add_fixed({{0, upper.front().tag}}, {air}, 0.007, growth_rate, size_limit, "a");
  field.add_fixed({{1, curves[1]}}, {air}, 0.009, growth_rate, size_limit, "bc");
  field.add_fixed({{1, curves[3]}}, {air}, 0.0075, growth_rate, size_limit, "de");
  field.add_fixed({{1, curves[5]}}, {air}, 0.007, growth_rate, size_limit, "fg");
  field.add_fixed({{1, curves[6]}}, {air}, 0.007, growth_rate, size_limit, "hj");
  field.add_fixed({{1, curves[8]}}, {air}, 0.009, growth_rate, size_limit, "kl");
  return {air, std::move(field)};
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string output = argc > 1 ? argv[1] : "airfoil.msh";
  const std::vector<std::string> words(argv + std::min(argc, 2), argv + argc);
  for (const std::string& word : words) {
    if (word != "six_fixed" && word != "quads") {
      throw std::invalid_argument("'" + word + "' is not known: give six_fixed, quads or neither.");
    }
  }
  const auto asked_for = [&words](const char* word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  gmsh::initialize();
  gmsh::option::setNumber("General.Verbosity", 2);
  gmsh::option::setNumber("Mesh.MeshSizeMax", size_limit);
  gmsh::option::setNumber("Mesh.Algorithm", frontal_delaunay);
  gmsh::model::add("airfoil");
  Model model = asked_for("six_fixed") ? build_split() : build_bunched();
  if (asked_for("quads")) {
    gmsh::model::mesh::setRecombine(2, model.air.second);
  }
  model.field.generate(2);
  std::cout << meshgrow::report_table({{"air", meshgrow::report(2, {model.air}, model.field)}});
  gmsh::write(output);
  std::cout << "To look at it: gmsh " << output << '\n';
  gmsh::finalize();
  return 0;
} catch (const std::exception& error) {
  std::cerr << "error: " << error.what() << '\n';
  return 1;
}
