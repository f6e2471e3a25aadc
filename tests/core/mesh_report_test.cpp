#include "mesh_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace meshgrow {
namespace {

const double height = std::sqrt(2.0 / 3.0);  // of the regular tetrahedron with sides 1

ReportElement element(ElementShape shape, const std::vector<std::uint32_t>& corners,
                      const Entity& entity) {
  ReportElement result;
  result.shape = shape;
  result.entity = entity;
  std::copy(corners.begin(), corners.end(), result.corners.begin());
  return result;
}

ReportElement tetrahedron(const std::vector<std::uint32_t>& corners) {
  return element(ElementShape::tetrahedron, corners, {3, 1});
}

ReportElement triangle(const std::vector<std::uint32_t>& corners) {
  return element(ElementShape::triangle, corners, {2, 1});
}

/// An equilateral triangle in z = 0 with sides 1, and the two apices above and below it.
std::vector<Vec3> regular_nodes() {
  const double third = std::sqrt(3.0) / 6.0;
  return {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, std::sqrt(0.75), 0), Vec3(0.5, third, height),
          Vec3(0.5, third, -height)};
}

/// Two regular tetrahedra that share a face.
ReportMesh twin_tetrahedra() {
  return {regular_nodes(), {tetrahedron({0, 1, 2, 3}), tetrahedron({0, 2, 1, 4})}};
}

// ==== Gradation

TEST(MeshReport, CornersOfEveryShape) {
  EXPECT_EQ(corner_count(ElementShape::triangle), 3);
  EXPECT_EQ(corner_count(ElementShape::quad), 4);
  EXPECT_EQ(corner_count(ElementShape::tetrahedron), 4);
  EXPECT_EQ(corner_count(ElementShape::hexahedron), 8);
  EXPECT_EQ(corner_count(ElementShape::prism), 6);
  EXPECT_EQ(corner_count(ElementShape::pyramid), 5);
}

TEST(MeshReport, TwoRegularTetrahedraThatShareAFace) {
  const MeshReport report = make_report(twin_tetrahedra());
  EXPECT_EQ(report.elements, 2u);
  EXPECT_NEAR(report.smallest_size, 1.0, 1e-14);
  EXPECT_NEAR(report.largest_size, 1.0, 1e-14);
  EXPECT_NEAR(report.ratio_max, 1.0, 1e-14);
  EXPECT_NEAR(report.ratio_99, 1.0, 1e-14);
  EXPECT_NEAR(report.gamma_min, 1.0, 1e-13);
  EXPECT_NEAR(report.gamma_mean, 1.0, 1e-13);
  EXPECT_NEAR(report.sicn_min, 1.0, 1e-13);
  EXPECT_NEAR(report.sicn_mean, 1.0, 1e-13);
}

TEST(MeshReport, RatioOfDifferentTetrahedra) {
  ReportMesh mesh = twin_tetrahedra();
  // The second one's three free edges become twice as long as they were: mean (3 + 3·2) / 6.
  mesh.nodes[4].z() = -std::sqrt(4.0 - 1.0 / 3.0);
  const MeshReport report = make_report(mesh);
  EXPECT_NEAR(report.smallest_size, 1.0, 1e-14);
  EXPECT_NEAR(report.largest_size, 1.5, 1e-14);
  EXPECT_NEAR(report.ratio_max, 1.5, 1e-14);
  EXPECT_NEAR(report.ratio_99, 1.5, 1e-14);
}

TEST(MeshReport, ElementsWithoutASharedFaceHaveNoRatio) {
  ReportMesh mesh = twin_tetrahedra();
  // A second apex of its own and an own copy of one corner: only an edge is shared.
  mesh.nodes.push_back(mesh.nodes[2]);
  mesh.elements[1] = tetrahedron({0, 5, 1, 4});
  const MeshReport report = make_report(mesh);
  EXPECT_EQ(report.elements, 2u);
  EXPECT_TRUE(std::isnan(report.ratio_max));
  EXPECT_TRUE(std::isnan(report.ratio_99));
}

TEST(MeshReport, RatioOfTrianglesIsOverSharedEdges) {
  // Equilateral, sides 1, and on its right side an isosceles one with sides 1, 2, 2.
  const double reach = std::sqrt(4.0 - 0.25);
  const Vec3 middle(0.75, std::sqrt(0.75) / 2.0, 0);
  const Vec3 outwards(std::sqrt(0.75), 0.5, 0);
  const ReportMesh mesh = {
      {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, std::sqrt(0.75), 0), middle + reach * outwards},
      {triangle({0, 1, 2}), triangle({1, 3, 2})}};
  const MeshReport report = make_report(mesh);
  EXPECT_NEAR(report.smallest_size, 1.0, 1e-14);
  EXPECT_NEAR(report.largest_size, 5.0 / 3.0, 1e-14);
  EXPECT_NEAR(report.ratio_max, 5.0 / 3.0, 1e-14);
}

TEST(MeshReport, RatioIsTakenAcrossEntities) {
  ReportMesh mesh = twin_tetrahedra();
  mesh.nodes[4].z() = -std::sqrt(4.0 - 1.0 / 3.0);
  mesh.elements[1].entity = {3, 2};
  EXPECT_NEAR(make_report(mesh).ratio_max, 1.5, 1e-14);
}

TEST(MeshReport, RatioOverEveryPairAtAnEdgeOfThreeTriangles) {
  // Three isosceles triangles on one edge of length 1, with legs 1, 2 and 4: sizes 1, 5/3 and 3.
  // The first and the last are neighbours as well.
  const auto apex = [](double leg, double angle) {
    const double reach = std::sqrt(leg * leg - 0.25);
    return Vec3(0.5, reach * std::cos(angle), reach * std::sin(angle));
  };
  const ReportMesh mesh = {{Vec3(0, 0, 0), Vec3(1, 0, 0), apex(1, 0.0), apex(2, 2.0), apex(4, 4.0)},
                           {triangle({0, 1, 2}), triangle({0, 1, 3}), triangle({0, 1, 4})}};
  EXPECT_NEAR(make_report(mesh).ratio_max, 3.0, 1e-13);
}

/// A strip of squares whose widths are 1, 1, … and then `last`: all ratios are 1 but the last.
ReportMesh strip(int squares, double last) {
  ReportMesh mesh;
  double x = 0.0;
  for (int i = 0; i <= squares; ++i) {
    mesh.nodes.emplace_back(x, 0, 0);
    mesh.nodes.emplace_back(x, 1, 0);
    x += i + 1 == squares ? last : 1.0;
    if (i > 0) {
      const auto first = static_cast<std::uint32_t>(2 * (i - 1));
      mesh.elements.push_back(
          element(ElementShape::quad, {first, first + 2, first + 3, first + 1}, {2, 1}));
    }
  }
  return mesh;
}

TEST(MeshReport, OneLargeRatioOfManyIsBeyond99Percent) {
  const MeshReport report = make_report(strip(201, 4.0));  // size (1 + 4) / 2
  EXPECT_NEAR(report.ratio_max, 2.5, 1e-14);
  EXPECT_NEAR(report.ratio_99, 1.0, 1e-14);
  EXPECT_NEAR(make_report(strip(11, 4.0)).ratio_99, 2.5, 1e-14);
}

TEST(MeshReport, QuadsShareEdges) {
  const MeshReport report = make_report(strip(2, 2.0));
  EXPECT_EQ(report.elements, 2u);
  EXPECT_NEAR(report.smallest_size, 1.0, 1e-14);
  EXPECT_NEAR(report.largest_size, 1.5, 1e-14);
  EXPECT_NEAR(report.ratio_max, 1.5, 1e-14);
  // Gmsh's measures are reported of triangles and tetrahedra only.
  EXPECT_TRUE(std::isnan(report.gamma_min));
  EXPECT_TRUE(std::isnan(report.sicn_mean));
}

/// Nodes of two boxes on each other: 1 × 1 × 1 below, 1 × 1 × 4 above.
std::vector<Vec3> two_boxes() {
  std::vector<Vec3> nodes;
  for (const double z : {0.0, 1.0, 5.0}) {
    for (const Vec3& p : {Vec3(0, 0, z), Vec3(1, 0, z), Vec3(1, 1, z), Vec3(0, 1, z)}) {
      nodes.push_back(p);
    }
  }
  return nodes;
}

TEST(MeshReport, HexahedraShareFaces) {
  const ReportMesh mesh = {two_boxes(),
                           {element(ElementShape::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7}, {3, 1}),
                            element(ElementShape::hexahedron, {4, 5, 6, 7, 8, 9, 10, 11}, {3, 1})}};
  const MeshReport report = make_report(mesh, [](const Entity&, const Vec3&) { return 1.0; });
  EXPECT_NEAR(report.smallest_size, 1.0, 1e-14);
  EXPECT_NEAR(report.largest_size, 2.0, 1e-14);  // (4 + 4 + 4·4) / 12
  EXPECT_NEAR(report.ratio_max, 2.0, 1e-14);
  // 20 edges: 16 as long as asked for, 4 four times as long.
  EXPECT_NEAR(report.length_median, 1.0, 1e-14);
  EXPECT_NEAR(report.length_share_good, 0.8, 1e-14);
  EXPECT_NEAR(report.length_share_over_2, 0.2, 1e-14);
}

TEST(MeshReport, NeighboursThroughEveryFaceOfAHexahedron) {
  // Whatever face of the unit cube carries a pyramid with edges 3 to its apex, the pair is found.
  const std::vector<std::vector<std::uint32_t>> faces = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                         {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  for (const std::vector<std::uint32_t>& face : faces) {
    ReportMesh mesh;
    mesh.nodes = two_boxes();
    mesh.nodes.resize(8);
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t node : face) {
      middle += mesh.nodes[node] / 4.0;
    }
    const Vec3 outwards = 2.0 * (middle - Vec3::Constant(0.5));
    mesh.nodes.push_back(middle + std::sqrt(9.0 - 0.5) * outwards);
    std::vector<std::uint32_t> pyramid = face;
    pyramid.push_back(8);
    mesh.elements = {element(ElementShape::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7}, {3, 1}),
                     element(ElementShape::pyramid, pyramid, {3, 1})};
    const MeshReport report = make_report(mesh);
    EXPECT_NEAR(report.largest_size, 2.0, 1e-14);  // (4·1 + 4·3) / 8
    EXPECT_NEAR(report.ratio_max, 2.0, 1e-14);
  }
}

TEST(MeshReport, NeighboursThroughEveryFaceOfAPrismOrPyramid) {
  const double half = std::sqrt(0.75);
  const std::vector<Vec3> prism_nodes = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, half, 0),
                                         Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(0.5, half, 1)};
  const std::vector<Vec3> pyramid_nodes = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0),
                                           Vec3(0, 1, 0), Vec3(0.5, 0.5, std::sqrt(0.5))};
  struct Host {
    ElementShape shape;
    std::vector<Vec3> nodes;
    std::vector<std::vector<std::uint32_t>> faces;
  };
  const std::vector<Host> hosts = {
      {ElementShape::prism,
       prism_nodes,
       {{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
      {ElementShape::pyramid,
       pyramid_nodes,
       {{0, 1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}}};
  for (const Host& host : hosts) {
    std::vector<std::uint32_t> corners;
    Vec3 centre = Vec3::Zero();
    for (std::uint32_t i = 0; i < host.nodes.size(); ++i) {
      corners.push_back(i);
      centre += host.nodes[i] / static_cast<double>(host.nodes.size());
    }
    for (const std::vector<std::uint32_t>& face : host.faces) {
      ReportMesh mesh;
      mesh.nodes = host.nodes;
      Vec3 middle = Vec3::Zero();
      for (const std::uint32_t node : face) {
        middle += mesh.nodes[node] / static_cast<double>(face.size());
      }
      mesh.nodes.push_back(middle + 3.0 * (middle - centre).normalized());
      std::vector<std::uint32_t> other = face;
      other.push_back(static_cast<std::uint32_t>(host.nodes.size()));
      mesh.elements = {element(host.shape, corners, {3, 1}),
                       element(face.size() == 4 ? ElementShape::pyramid : ElementShape::tetrahedron,
                               other, {3, 1})};
      const MeshReport report = make_report(mesh);
      EXPECT_NEAR(report.smallest_size, 1.0, 1e-14);
      EXPECT_GT(report.largest_size, 1.5);
      EXPECT_NEAR(report.ratio_max, report.largest_size, 1e-13);
    }
  }
}

// ==== Lengths

/// Elements without neighbours: each is a right triangle of its own with the legs 1 and `leg`.
ReportMesh separate_triangles(const std::vector<double>& legs) {
  ReportMesh mesh;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.nodes.size());
    const double x = 100.0 * static_cast<double>(i);
    mesh.nodes.emplace_back(x, 0, 0);
    mesh.nodes.emplace_back(x + 1.0, 0, 0);
    mesh.nodes.emplace_back(x, legs[i], 0);
    mesh.elements.push_back(triangle({first, first + 1, first + 2}));
  }
  return mesh;
}

TEST(MeshReport, LengthsAgainstTheSizeAskedFor) {
  // Edges 1, 2, √5 and 1, 0.5, √1.25; asked for 1: 1, 2, 2.24, 1, 0.5, 1.12.
  // Good: 1, 1, 1.12. Over 2: 2.24. With one more edge left out, the median would be another.
  const ReportMesh mesh = separate_triangles({2.0, 0.5});
  const MeshReport report = make_report(mesh, [](const Entity&, const Vec3&) { return 1.0; });
  EXPECT_NEAR(report.length_share_good, 3.0 / 6.0, 1e-14);
  EXPECT_NEAR(report.length_share_over_2, 1.0 / 6.0, 1e-14);
  const MeshReport halved = make_report(mesh, [](const Entity&, const Vec3&) { return 2.0; });
  // 0.5, 1, 1.12, 0.5, 0.25, 0.56
  EXPECT_NEAR(halved.length_share_good, 2.0 / 6.0, 1e-14);
  EXPECT_EQ(halved.length_share_over_2, 0.0);
}

TEST(MeshReport, MedianOfLengths) {
  // Edges 1, 2, √5; the median of three is the one in the middle.
  const MeshReport report =
      make_report(separate_triangles({2.0}), [](const Entity&, const Vec3&) { return 0.5; });
  EXPECT_NEAR(report.length_median, 4.0, 1e-13);
  const MeshReport nine = make_report(separate_triangles({2.0, 3.0, 4.0}),
                                      [](const Entity&, const Vec3&) { return 1.0; });
  // 1, 1, 1, 2, √5, 3, √10, 4, √17
  EXPECT_NEAR(nine.length_median, std::sqrt(5.0), 1e-13);
}

TEST(MeshReport, GoodLengthsAreFromRootOfHalfToRootOfTwo) {
  const ReportMesh mesh = separate_triangles({1.0});  // edges 1, 1, √2
  const auto share_good = [&](double asked_on_legs) {
    return make_report(mesh,
                       [=](const Entity&, const Vec3& midpoint) {
                         return midpoint.x() > 0.0 && midpoint.y() > 0.0 ? 0.01 : asked_on_legs;
                       })
        .length_share_good;
  };
  EXPECT_NEAR(share_good(std::sqrt(2.0) - 1e-6), 2.0 / 3.0, 1e-14);
  EXPECT_NEAR(share_good(std::sqrt(2.0) + 1e-6), 0.0, 1e-14);
  EXPECT_NEAR(share_good(std::sqrt(0.5) + 1e-6), 2.0 / 3.0, 1e-14);
  EXPECT_NEAR(share_good(std::sqrt(0.5) - 1e-6), 0.0, 1e-14);
}

TEST(MeshReport, SizeIsAskedForAtTheMidpointOnTheEntity) {
  ReportMesh mesh = separate_triangles({2.0});
  mesh.elements[0].entity = {2, 17};
  std::vector<Vec3> asked;
  make_report(mesh, [&](const Entity& entity, const Vec3& p) {
    EXPECT_EQ(entity, (Entity{2, 17}));
    asked.push_back(p);
    return 1.0;
  });
  ASSERT_EQ(asked.size(), 3u);
  for (const Vec3& midpoint : {Vec3(0.5, 0, 0), Vec3(0, 1, 0), Vec3(0.5, 1, 0)}) {
    EXPECT_EQ(std::count(asked.begin(), asked.end(), midpoint), 1) << midpoint.transpose();
  }
}

TEST(MeshReport, SharedEdgesCountOncePerEntity) {
  std::size_t asked = 0;
  const SizeAsked count = [&](const Entity&, const Vec3&) {
    ++asked;
    return 1.0;
  };
  ReportMesh mesh = twin_tetrahedra();
  make_report(mesh, count);
  EXPECT_EQ(asked, 9u);  // 6 + 6 − 3
  mesh.elements[1].entity = {3, 2};
  asked = 0;
  make_report(mesh, count);
  EXPECT_EQ(asked, 12u);
}

TEST(MeshReport, EdgesWithoutASizeAreLeftOut) {
  // The short leg gets no size; what is left is 2 and √5.
  for (const double none : {std::numeric_limits<double>::infinity(), MeshReport::unknown}) {
    const MeshReport report = make_report(
        separate_triangles({2.0}),
        [=](const Entity&, const Vec3& midpoint) { return midpoint.y() == 0.0 ? none : 1.0; });
    EXPECT_NEAR(report.length_share_over_2, 0.5, 1e-14);
    EXPECT_EQ(report.length_share_good, 0.0);
  }
}

TEST(MeshReport, NoSizesLeaveTheLengthsUnknown) {
  const ReportMesh mesh = twin_tetrahedra();
  for (const SizeAsked& asked : {SizeAsked(), SizeAsked([](const Entity&, const Vec3&) {
                                   return std::numeric_limits<double>::infinity();
                                 })}) {
    const MeshReport report = make_report(mesh, asked);
    EXPECT_TRUE(std::isnan(report.length_median));
    EXPECT_TRUE(std::isnan(report.length_share_good));
    EXPECT_TRUE(std::isnan(report.length_share_over_2));
    EXPECT_NEAR(report.ratio_max, 1.0, 1e-14);
  }
}

// ==== Quality

TEST(MeshReport, InvertedTetrahedronHasNegativeSicn) {
  ReportMesh mesh = twin_tetrahedra();
  std::swap(mesh.elements[1].corners[0], mesh.elements[1].corners[1]);
  const MeshReport report = make_report(mesh);
  EXPECT_NEAR(report.sicn_min, -1.0, 1e-13);
  EXPECT_NEAR(report.sicn_mean, 0.0, 1e-13);
  EXPECT_NEAR(report.gamma_min, 1.0, 1e-13);
  EXPECT_NEAR(report.ratio_max, 1.0, 1e-13);
}

TEST(MeshReport, QualityOfTheCornerOfACube) {
  const ReportMesh mesh = {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
                           {tetrahedron({0, 1, 2, 3})}};
  const MeshReport report = make_report(mesh);
  // Inscribed radius 3 V / A = 0.5 / (1.5 + √¾), circumscribed half of the cube's diagonal.
  EXPECT_NEAR(report.gamma_min, 3.0 * 0.5 / (1.5 + std::sqrt(0.75)) / std::sqrt(0.75), 1e-13);
  // Norms √3 · √1.5 and √1.5 · √3 of the map from the regular tetrahedron and back: 3 / √13.5.
  EXPECT_NEAR(report.sicn_min, std::sqrt(2.0 / 3.0), 1e-13);
}

TEST(MeshReport, QualityDoesNotDependOnScaleAndOrder) {
  const std::vector<Vec3> nodes = {Vec3(0.1, 0, 0), Vec3(1, 0.2, 0), Vec3(0.3, 0.9, 0.1),
                                   Vec3(0.2, 0.4, 0.5)};
  const MeshReport one = make_report({nodes, {tetrahedron({0, 1, 2, 3})}});
  EXPECT_GT(one.gamma_min, 0.3);
  EXPECT_GT(one.sicn_min, 0.3);
  const std::vector<std::vector<std::uint32_t>> even_orders = {
      {1, 2, 0, 3}, {1, 0, 3, 2}, {3, 1, 0, 2}};
  for (const std::vector<std::uint32_t>& order : even_orders) {
    std::vector<Vec3> scaled;
    for (const Vec3& node : nodes) {
      scaled.push_back(1e-6 * node);
    }
    const MeshReport other = make_report({scaled, {tetrahedron(order)}});
    EXPECT_NEAR(other.gamma_min, one.gamma_min, 1e-12);
    EXPECT_NEAR(other.sicn_min, one.sicn_min, 1e-12);
  }
}

TEST(MeshReport, QualityOfTriangles) {
  ReportMesh mesh = {regular_nodes(), {triangle({0, 1, 2})}};
  MeshReport report = make_report(mesh);
  EXPECT_NEAR(report.gamma_min, 1.0, 1e-14);
  EXPECT_NEAR(report.sicn_min, 1.0, 1e-14);
  // Right and isosceles: 2 r / R = 2 (√2 − 1); 4 √3 area / Σ squares = √3 / 2.
  mesh.nodes = {Vec3(0, 0, 5), Vec3(2, 0, 5), Vec3(0, 2, 5)};
  report = make_report(mesh);
  EXPECT_NEAR(report.gamma_min, 2.0 * (std::sqrt(2.0) - 1.0), 1e-14);
  EXPECT_NEAR(report.sicn_min, std::sqrt(0.75), 1e-14);
}

TEST(MeshReport, MinimumAndMeanOfQuality) {
  ReportMesh mesh;
  mesh.nodes = regular_nodes();
  mesh.nodes.resize(3);
  mesh.nodes.insert(mesh.nodes.end(), {Vec3(0, 0, 5), Vec3(2, 0, 5), Vec3(0, 2, 5)});
  mesh.elements = {triangle({0, 1, 2}), triangle({3, 4, 5}), triangle({0, 1, 2})};
  const MeshReport report = make_report(mesh);
  const double gamma = 2.0 * (std::sqrt(2.0) - 1.0);
  EXPECT_NEAR(report.gamma_min, gamma, 1e-14);
  EXPECT_NEAR(report.gamma_mean, (2.0 + gamma) / 3.0, 1e-14);
  EXPECT_NEAR(report.sicn_min, std::sqrt(0.75), 1e-14);
  EXPECT_NEAR(report.sicn_mean, (2.0 + std::sqrt(0.75)) / 3.0, 1e-14);
}

TEST(MeshReport, FlatElementsHaveNoQuality) {
  const std::vector<Vec3> nodes = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(0, 1, 0)};
  for (const ReportElement& flat :
       {triangle({0, 1, 2}), tetrahedron({0, 1, 2, 3}), tetrahedron({0, 1, 3, 3})}) {
    const MeshReport report = make_report({nodes, {flat}});
    EXPECT_EQ(report.gamma_min, 0.0);
    EXPECT_EQ(report.sicn_min, 0.0);
  }
}

// ==== Empty meshes and tables

TEST(MeshReport, EmptyMeshIsUnknown) {
  const MeshReport report =
      make_report(ReportMesh(), [](const Entity&, const Vec3&) { return 1.0; });
  EXPECT_EQ(report.elements, 0u);
  for (const double value :
       {report.smallest_size, report.largest_size, report.ratio_max, report.ratio_99,
        report.length_median, report.length_share_good, report.length_share_over_2,
        report.gamma_min, report.gamma_mean, report.sicn_min, report.sicn_mean}) {
    EXPECT_TRUE(std::isnan(value)) << value;
  }
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// Characters, of which UTF-8 may need several bytes.
std::size_t width(const std::string& text) {
  std::size_t count = 0;
  for (const char c : text) {
    count += (static_cast<unsigned char>(c) & 0xC0) == 0x80 ? 0 : 1;
  }
  return count;
}

/// Columns end where their headings end, since they stand at the right.
std::string cell_under(const std::vector<std::string>& lines, std::size_t row,
                       const std::string& heading, const std::string& heading_before) {
  const std::size_t begin = lines[0].find(heading_before) + heading_before.size();
  const std::size_t end = lines[0].find(heading, begin) + heading.size();
  const std::string cell = lines[row].substr(begin, end - begin);
  return cell.substr(cell.find_first_not_of(' '));
}

TEST(ReportTable, ShowsValuesUnderTheirHeadings) {
  const MeshReport twin = make_report(twin_tetrahedra(), [](const Entity&, const Vec3&) {
    return 0.8;  // lengths of 1.25
  });
  ReportMesh many = strip(1234, 4.0);
  const std::vector<std::string> lines =
      lines_of(report_table({{"twin", twin}, {"a long name", make_report(many)}}));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[1].substr(0, 5), "twin ");
  EXPECT_EQ(lines[2].substr(0, 12), "a long name ");
  EXPECT_EQ(cell_under(lines, 1, "elements", "mesh"), "2");
  EXPECT_EQ(cell_under(lines, 1, "ratio max", "max"), "1.00");
  EXPECT_EQ(cell_under(lines, 1, "length/size", "99 %"), "1.25");
  EXPECT_EQ(cell_under(lines, 1, "good", "length/size"), "100.0 %");
  EXPECT_EQ(cell_under(lines, 1, "> 2", "good"), "0.0 %");
  EXPECT_EQ(cell_under(lines, 1, "gamma min", "> 2"), "1.000");
  EXPECT_EQ(cell_under(lines, 2, "size min", "elements"), "1");
  EXPECT_EQ(cell_under(lines, 2, "max", "size min"), "2.5");
  EXPECT_EQ(cell_under(lines, 2, "ratio max", "max"), "2.50");
  EXPECT_EQ(cell_under(lines, 2, "99 %", "ratio max"), "1.00");
  EXPECT_EQ(cell_under(lines, 2, "length/size", "99 %"), "-");
  EXPECT_EQ(cell_under(lines, 2, "gamma min", "> 2"), "-");
  EXPECT_NE(lines[2].find("1,234"), std::string::npos);
}

TEST(ReportTable, UnknownValuesAreDashes) {
  const std::vector<std::string> lines =
      lines_of(report_table({{"nothing", make_report(ReportMesh())}}));
  ASSERT_EQ(lines.size(), 2u);
  std::istringstream row(lines[1]);
  std::vector<std::string> cells;
  for (std::string cell; row >> cell;) {
    cells.push_back(cell);
  }
  ASSERT_EQ(cells.size(), 13u);
  EXPECT_EQ(cells[0], "nothing");
  EXPECT_EQ(cells[1], "0");
  for (std::size_t i = 2; i < cells.size(); ++i) {
    EXPECT_EQ(cells[i], "-") << "column " << i;
  }
}

TEST(ReportTable, LinesUp) {
  const MeshReport twin = make_report(twin_tetrahedra());
  const std::vector<std::string> lines =
      lines_of(report_table({{"Gehäuse, größer", twin},
                             {"x", make_report(strip(1234, 1e-7))},
                             {"", make_report(ReportMesh())}}));
  ASSERT_EQ(lines.size(), 4u);
  for (const std::string& line : lines) {
    EXPECT_EQ(width(line), width(lines[0])) << line;
  }
}

TEST(ReportTable, HeadingsWithoutReports) {
  const std::vector<std::string> lines = lines_of(report_table({}));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("ratio max"), std::string::npos);
}

}  // namespace
}  // namespace meshgrow
