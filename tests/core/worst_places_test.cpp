#include "worst_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "error.h"

namespace meshgrow {
namespace {

/// A row of triangles over [0, 1, 3, 7, 15] × [0, 1]: each cell twice as wide as the one before and
/// cut in two, cells in surface 1 up to x = 3 and in surface 2 beyond. Tags from 101 on.
ReportMesh growing_row() {
  ReportMesh mesh;
  for (const double x : {0.0, 1.0, 3.0, 7.0, 15.0}) {
    mesh.nodes.emplace_back(x, 0.0, 0.0);
    mesh.nodes.emplace_back(x, 1.0, 0.0);
  }
  for (std::uint32_t cell = 0; cell < 4; ++cell) {
    const std::uint32_t n = 2 * cell;
    for (const auto& corners : {std::array<std::uint32_t, 3>{n, n + 2, n + 1},
                                std::array<std::uint32_t, 3>{n + 1, n + 2, n + 3}}) {
      ReportElement element;
      element.shape = ElementShape::triangle;
      element.entity = {2, cell < 2 ? 1 : 2};
      std::copy(corners.begin(), corners.end(), element.corners.begin());
      element.tag = 101 + mesh.elements.size();
      mesh.elements.push_back(element);
    }
  }
  return mesh;
}

double mean_edge(double width) { return (width + 1.0 + std::hypot(width, 1.0)) / 3.0; }

TEST(WorstPlaces, NeighboursByTheirSizeRatio) {
  const std::vector<WorstPlace> places = worst_places(growing_row(), {}, "ratio_99", true, 3);
  ASSERT_EQ(places.size(), 3u);
  // Over the edges at x = 7, 3 and 1.
  EXPECT_NEAR(places[0].value, mean_edge(8) / mean_edge(4), 1e-14);
  EXPECT_EQ(places[0].elements, (std::vector<std::size_t>{106, 107}));
  EXPECT_EQ(places[0].entity, (Entity{2, 2}));
  EXPECT_NEAR((places[0].point - Vec3(23.0 / 3.0, 0.5, 0)).norm(), 0.0, 1e-14);
  EXPECT_EQ(places[1].elements, (std::vector<std::size_t>{104, 105}));
  EXPECT_EQ(places[1].entity, (Entity{2, 1}));
  EXPECT_EQ(places[2].elements, (std::vector<std::size_t>{102, 103}));
  const std::vector<WorstPlace> least = worst_places(growing_row(), {}, "ratio_max", false, 100);
  ASSERT_EQ(least.size(), 7u);
  EXPECT_EQ(least.front().value, 1.0);
  EXPECT_EQ(least.front().elements, (std::vector<std::size_t>{101, 102}));
}

TEST(WorstPlaces, TheFirstPlaceIsTheNumberOfTheReport) {
  const ReportMesh mesh = growing_row();
  const MeshReport report = make_report(mesh);
  EXPECT_EQ(worst_places(mesh, {}, "ratio_max", true, 1).at(0).value, report.ratio_max);
  EXPECT_EQ(worst_places(mesh, {}, "gamma_min", false, 1).at(0).value, report.gamma_min);
  EXPECT_EQ(worst_places(mesh, {}, "sicn_min", false, 1).at(0).value, report.sicn_min);
  EXPECT_EQ(worst_places(mesh, {}, "smallest_size", false, 1).at(0).value, report.smallest_size);
  EXPECT_EQ(worst_places(mesh, {}, "largest_size", true, 1).at(0).value, report.largest_size);
}

TEST(WorstPlaces, ElementsByQuality) {
  const std::vector<WorstPlace> places = worst_places(growing_row(), {}, "gamma_mean", false, 2);
  ASSERT_EQ(places.size(), 2u);
  EXPECT_EQ(places[0].elements, std::vector<std::size_t>{107});
  EXPECT_EQ(places[1].elements, std::vector<std::size_t>{108});
  EXPECT_NEAR((places[0].point - Vec3(29.0 / 3.0, 1.0 / 3.0, 0)).norm(), 0.0, 1e-14);
}

TEST(WorstPlaces, EdgesByTheirLengthOverTheSizeAskedFor) {
  const SizeAsked size = [](const Entity& entity, const Vec3&) {
    return entity.tag == 2 ? 4.0 : std::numeric_limits<double>::infinity();
  };
  const ReportMesh mesh = growing_row();
  const std::vector<WorstPlace> longest = worst_places(mesh, size, "length_share_over_2", true, 1);
  ASSERT_EQ(longest.size(), 1u);
  EXPECT_NEAR(longest[0].value, std::hypot(8.0, 1.0) / 4.0, 1e-14);
  EXPECT_EQ(longest[0].elements, std::vector<std::size_t>{107});
  EXPECT_NEAR((longest[0].point - Vec3(11.0, 0.5, 0)).norm(), 0.0, 1e-14);
  // An edge of 1 is further from 4 than one of 8 is; the one at x = 3 counts in surface 2 only.
  const std::vector<WorstPlace> unfit = worst_places(mesh, size, "length_share_good", false, 3);
  for (const WorstPlace& place : unfit) {
    EXPECT_EQ(place.value, 0.25);
    EXPECT_EQ(place.entity, (Entity{2, 2}));
  }
  EXPECT_EQ(worst_places(mesh, size, "length_share_good", true, 1).at(0).value, 1.0);
  EXPECT_TRUE(worst_places(mesh, {}, "length_median", true, 5).empty());
}

TEST(WorstPlaces, ElementsWithoutExtentComeFirst) {
  ReportMesh mesh = growing_row();
  mesh.nodes[8] = mesh.nodes[6];
  mesh.nodes[9] = mesh.nodes[6];
  mesh.nodes[7] = mesh.nodes[6];
  const WorstPlace worst = worst_places(mesh, {}, "ratio_max", true, 1).at(0);
  EXPECT_FALSE(std::isfinite(worst.value));
}

TEST(WorstPlaces, NoneForTheNumberOfElementsAndNoOtherNames) {
  EXPECT_TRUE(worst_places(growing_row(), {}, "elements", true, 5).empty());
  EXPECT_THROW(worst_places(growing_row(), {}, "beauty", true, 5), Error);
  EXPECT_TRUE(worst_places({}, {}, "ratio_99", true, 5).empty());
}

}  // namespace
}  // namespace meshgrow
