// Facets of geometry without a mesh, through the Gmsh that MESHGROW_GMSH_LIB names.

#include "source_facets.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "gmsh_api.h"
#include "model_reader.h"
#include "node_numbers.h"
#include "start_sizes/curvature_start_sizes.h"
#include "temporary_directory.h"

namespace meshgrow {
namespace {

const double pi = std::acos(-1.0);
constexpr double angle = 18.0;

class SourceFacetsOf : public testing::Test {
 protected:
  void SetUp() override { gmsh::initialize({"test", "-v", "2"}); }
  void TearDown() override { gmsh::finalize(); }

  /// Opens a model that is written as in a .geo file.
  static Topology model(const std::string& text) {
    const TemporaryDirectory directory;
    const std::string path = (directory.path() / "model.geo").string();
    // A line for each statement: 4.8 passes over some that stand in one line.
    std::ofstream(path) << std::regex_replace(text, std::regex("; "), ";\n") << '\n';
    gmsh::open(path);
    return read_topology();
  }

  static SizeFunction curvature_function() {
    SizeFunction function;
    function.kind = Kind::curvature;
    function.angle = angle;
    function.size_limit = 1e6;
    return function;
  }

  using ClosedForm = std::function<double(const Vec3&)>;

  /// Start sizes of the facets against the closed form of the largest curvature, at their centres.
  static void expect_sizes(const Topology& topology, const Entity& entity, const ClosedForm& form,
                           std::size_t most_facets) {
    const NodeCoordinates nodes;
    SizedFacets facets;
    append_curvature_start_sizes(
        SourceFacets(topology, nodes).with_curvature(entity, curvature_function()),
        {angle, 0.0, 1e6}, 0.0, facets);
    ASSERT_FALSE(facets.empty());
    EXPECT_LE(facets.size(), most_facets);
    double worst = 0.0;
    for (const SizedFacet& facet : facets) {
      const double expected = curvature_start_size(form(facet.facet.centroid()), angle);
      worst = std::max(worst, std::abs(facet.start_size / expected - 1.0));
    }
    EXPECT_LE(worst, 0.02) << entity_name(entity) << ", " << facets.size() << " facets";
  }

  static double area_of(const FacetedSource& source) {
    double area = 0.0;
    for (const auto& [a, b, c] : source.triangles) {
      area += 0.5 * (b - a).cross(c - a).norm();
    }
    return area;
  }
};

// ==== Curvature of CAD against closed forms

TEST_F(SourceFacetsOf, Circles) {
  for (const char* kernel : {"OpenCASCADE", "Built-in"}) {
    const Topology topology =
        model(std::string("SetFactory(\"") + kernel +
              "\"); Point(1) = {0,0,0}; Point(2) = {2,0,0}; Point(3) = {0,2,0}; "
              "Circle(1) = {2,1,3};");
    expect_sizes(
        topology, {1, 1}, [](const Vec3&) { return 0.5; }, 100);
  }
}

TEST_F(SourceFacetsOf, Sphere) {
  const Topology topology = model("SetFactory(\"OpenCASCADE\"); Sphere(1) = {5,6,7,2};");
  expect_sizes(
      topology, {2, 1}, [](const Vec3&) { return 0.5; }, 20000);
}

TEST_F(SourceFacetsOf, Cylinder) {
  const Topology topology =
      model("SetFactory(\"OpenCASCADE\"); Cylinder(1) = {0,0,0, 0,0,100, 0.5, Pi};");
  for (const Entity& surface : topology.entities(2)) {
    if (gmsh::entity_type(surface) == "Cylinder") {
      // As long as it is thin: pieces need not be short along straight lines.
      expect_sizes(
          topology, surface, [](const Vec3&) { return 2.0; }, 200);
    }
  }
}

TEST_F(SourceFacetsOf, Cone) {
  const Topology topology = model("SetFactory(\"OpenCASCADE\"); Cone(1) = {0,0,0, 0,0,3, 1, 0};");
  const double slope = std::atan(1.0 / 3.0);
  expect_sizes(
      topology, {2, 1},
      [=](const Vec3& p) {
        // On the cone, though the centre of a facet is a little inside.
        const double radius = (3.0 - p.z()) / 3.0;
        return std::cos(slope) / radius;
      },
      30000);
}

TEST_F(SourceFacetsOf, Torus) {
  const Topology topology = model("SetFactory(\"OpenCASCADE\"); Torus(1) = {0,0,0, 1.5, 1};");
  expect_sizes(
      topology, {2, 1},
      [](const Vec3& p) {
        const double rho = std::hypot(p.x(), p.y());
        const double tube = std::hypot(rho - 1.5, p.z());  // near 1
        const double cosine = (rho - 1.5) / tube;
        return std::max(1.0, std::abs(cosine / (1.5 + cosine)));
      },
      60000);
}

TEST_F(SourceFacetsOf, Ellipsoid) {
  const Topology topology = model(
      "SetFactory(\"OpenCASCADE\"); Sphere(1) = {0,0,0,1}; Dilate{{0,0,0},{1,1.5,2}}{Volume{1};}");
  const Vec3 axes2(1.0, 2.25, 4.0);
  expect_sizes(
      topology, {2, 1},
      [&](const Vec3& inside) {
        const Vec3 p = inside / std::sqrt((inside.array().square() / axes2.array()).sum());
        const Vec3 gradient = 2.0 * p.cwiseQuotient(axes2);
        const Vec3 normal = gradient.normalized();
        const Eigen::Matrix3d tangent = Eigen::Matrix3d::Identity() - normal * normal.transpose();
        const Eigen::Matrix3d shape =
            tangent * (2.0 * axes2.cwiseInverse()).asDiagonal() * tangent / gradient.norm();
        return shape.operatorNorm();
      },
      30000);
}

TEST_F(SourceFacetsOf, RuledAndSphericalSurfacesOfTheBuiltInKernel) {
  // Gmsh's own curvature is wrong there.
  const Topology topology = model(
      "Point(1) = {0,0,0}; Point(2) = {1,0,0}; Point(3) = {0,1,0}; Point(4) = {0,0,1}; "
      "Circle(1) = {2,1,3}; Circle(2) = {3,1,4}; Circle(3) = {4,1,2}; Curve Loop(1) = {1,2,3}; "
      "Surface(1) = {1}; Extrude{0,0,3}{Curve{1};}");
  for (const Entity& surface : topology.entities(2)) {
    expect_sizes(
        topology, surface, [](const Vec3&) { return 1.0; }, 5000);
  }
}

TEST_F(SourceFacetsOf, FlatFacesHaveNoCurvature) {
  const Topology topology = model("SetFactory(\"OpenCASCADE\"); Box(1) = {0,0,0, 1,2,3};");
  const NodeCoordinates nodes;
  SourceFacets facets(topology, nodes);
  for (const Entity& surface : topology.entities(2)) {
    const FacetedSource source = facets.with_curvature(surface, curvature_function());
    EXPECT_EQ(source.triangles.size(), 2u);
    for (const double curvature : source.triangle_curvatures) {
      EXPECT_NEAR(curvature, 0.0, 1e-9);
    }
  }
}

// ==== Facets that fit

struct Solid {
  std::string text;
  double area;  ///< of all faces, by closed forms
};

const std::vector<Solid>& solids() {
  static const std::vector<Solid> all = {
      {"Box(1) = {0,0,0, 1,2,3};", 22.0},
      {"Sphere(1) = {0,0,0, 2};", 16.0 * pi},
      {"Cylinder(1) = {0,0,0, 0,0,3, 0.5};", 3.5 * pi},
      {"Cone(1) = {0,0,0, 0,0,3, 1, 0};", pi * (1.0 + std::sqrt(10.0))},
      {"Torus(1) = {0,0,0, 3, 1};", 12.0 * pi * pi},
      {"Box(1) = {0,0,0, 4,4,1}; Cylinder(2) = {2,2,-1, 0,0,3, 1}; "
       "BooleanDifference{Volume{1}; Delete;}{Volume{2}; Delete;}",
       48.0 - 2.0 * pi + 2.0 * pi},
      // A quarter of a sphere: two poles, two seams that are edges.
      {"Sphere(1) = {0,0,0, 1, 0, Pi/2, Pi/2};", 0.5 * pi + 0.75 * pi},
      // Cut off at their seams.
      {"Sphere(1) = {0,0,0, 1}; Box(2) = {0,0,0, 2,2,2}; "
       "BooleanIntersection{Volume{1}; Delete;}{Volume{2}; Delete;}",
       0.5 * pi + 0.75 * pi},
      {"Torus(1) = {0,0,0, 1, 0.2}; Box(2) = {0,0,-1, 3,3,2}; "
       "BooleanDifference{Volume{1}; Delete;}{Volume{2}; Delete;}",
       0.75 * 4.0 * pi * pi * 0.2 + 2.0 * pi * 0.04},
      {"Box(1) = {0,0,0, 2,2,2}; Fillet{1}{1,2,3,4,5,6,7,8,9,10,11,12}{0.5}",
       6.0 + 12.0 * 0.25 * pi + pi},
  };
  return all;
}

TEST_F(SourceFacetsOf, SolidsAreWaterproofAndHaveTheirArea) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.text);
    const Topology topology = model("SetFactory(\"OpenCASCADE\"); " + solid.text);
    ShapeSampler sampler(topology, 6.0);
    NodeNumbers numbers;
    std::map<NodePair, int> sides;
    double area = 0.0;
    for (const Entity& surface : topology.entities(2)) {
      const auto sampled = sampler.surface(surface);
      ASSERT_TRUE(sampled) << entity_name(surface);
      FacetedSource source;
      for (const auto& triangle : sampled->triangles) {
        source.triangles.push_back({sampled->points[triangle[0]], sampled->points[triangle[1]],
                                    sampled->points[triangle[2]]});
        for (int i = 0; i < 3; ++i) {
          ++sides[node_pair(numbers.of(source.triangles.back()[i]),
                            numbers.of(source.triangles.back()[(i + 1) % 3]))];
        }
      }
      area += area_of(source);
    }
    EXPECT_NEAR(area, solid.area, 0.004 * solid.area);
    const auto open = std::count_if(sides.begin(), sides.end(),
                                    [](const auto& side) { return side.second != 2; });
    EXPECT_EQ(open, 0) << "sides that are not of two triangles, of " << sides.size();
  }
}

TEST_F(SourceFacetsOf, FacetsTurnByNoMoreThanTheAngle) {
  const Topology topology = model("SetFactory(\"OpenCASCADE\"); Sphere(1) = {0,0,0,1};");
  for (const double turn : {3.0, 6.0, 15.0}) {
    const auto sampled = ShapeSampler(topology, turn).surface({2, 1});
    ASSERT_TRUE(sampled);
    double worst = 0.0;
    for (const auto& triangle : sampled->triangles) {
      for (int i = 0; i < 3; ++i) {
        worst = std::max(worst, turn_between(sampled->points[triangle[i]],
                                             sampled->points[triangle[(i + 1) % 3]]));
      }
    }
    EXPECT_LE(worst, 1.05 * turn);
    EXPECT_GE(worst, 0.5 * turn) << "no finer than needed";
  }
}

TEST_F(SourceFacetsOf, FacetsDoNotLieAskew) {
  // Long ones across the bend of a pipe would, though the normals at their corners agree.
  const Topology topology = model(
      "SetFactory(\"OpenCASCADE\"); Point(1) = {1,0,0}; Point(2) = {0.54,0.84,0.3}; "
      "Point(3) = {-0.42,0.91,0.6}; Point(4) = {-0.99,0.14,0.9}; Point(5) = {-0.65,-0.76,1.2}; "
      "Spline(1) = {1,2,3,4,5}; Wire(1) = {1}; Disk(1) = {1,0,0, 0.1}; "
      "Rotate{{1,0,0}, {1,0,0}, Pi/2}{Surface{1};} "
      "Extrude{Surface{1};} Using Wire {1}");
  double area = 0.0;
  double area_askew = 0.0;
  for (const Entity& surface : topology.entities(2)) {
    const auto sampled = ShapeSampler(topology, 6.0).surface(surface);
    ASSERT_TRUE(sampled) << entity_name(surface);
    std::vector<double> centres;
    for (const auto& triangle : sampled->triangles) {
      for (int axis = 0; axis < 2; ++axis) {
        double sum = 0.0;
        for (const std::size_t corner : triangle) {
          sum += sampled->parameters[corner][axis];
        }
        centres.push_back(sum / 3.0);
      }
    }
    const std::vector<Vec3> normals = gmsh::normals_at(surface, centres);
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const auto& [a, b, c] = sampled->triangles[i];
      const Vec3& corner = sampled->points[a];
      const Vec3 normal = (sampled->points[b] - corner).cross(sampled->points[c] - corner);
      const double turn = turn_between(normal, normals[i]);
      area += normal.norm();
      area_askew += std::min(turn, 180.0 - turn) > 9.0 ? normal.norm() : 0.0;
    }
  }
  EXPECT_LE(area_askew, 0.003 * area) << area_askew / area;
}

TEST_F(SourceFacetsOf, EmbeddedCurvesAreSidesOfFacets) {
  const Topology topology = model(
      "Point(1) = {0,0,0}; Point(2) = {4,0,0}; Point(3) = {4,4,0}; Point(4) = {0,4,0}; "
      "Point(5) = {1,1,0}; Point(6) = {3,2,0}; Line(1) = {1,2}; Line(2) = {2,3}; "
      "Line(3) = {3,4}; Line(4) = {4,1}; Line(5) = {5,6}; Curve Loop(1) = {1,2,3,4}; "
      "Plane Surface(1) = {1}; Curve{5} In Surface{1};");
  const NodeCoordinates nodes;
  SourceFacets facets(topology, nodes);
  int looking_at_the_embedded_curve = 0;
  for (const Wall& wall : facets.walls({2, 1})) {
    looking_at_the_embedded_curve += wall.entity == Entity{1, 5} ? 1 : 0;
  }
  EXPECT_EQ(looking_at_the_embedded_curve, 2) << "one from each side";
}

TEST_F(SourceFacetsOf, PoleOfASphereHasNoCurvatureAsACurve) {
  const Topology topology = model("SetFactory(\"OpenCASCADE\"); Sphere(1) = {0,0,0,1};");
  const NodeCoordinates nodes;
  SourceFacets facets(topology, nodes);
  int poles = 0;
  for (const Entity& curve : topology.entities(1)) {
    if (gmsh::entity_type(curve) != "Circle") {
      ++poles;
      EXPECT_TRUE(facets.with_curvature(curve, curvature_function()).empty());
    }
  }
  EXPECT_EQ(poles, 2);
}

TEST_F(SourceFacetsOf, SeamsAreNoWalls) {
  const Topology topology =
      model("SetFactory(\"OpenCASCADE\"); Cylinder(1) = {0,0,0, 0,0,3, 0.5};");
  const NodeCoordinates nodes;
  SourceFacets facets(topology, nodes);
  for (const Wall& wall : facets.walls({2, 1})) {
    EXPECT_NEAR(std::abs(wall.inward.z()), 1.0, 1e-9) << entity_name(wall.entity);
  }
}

}  // namespace
}  // namespace meshgrow
