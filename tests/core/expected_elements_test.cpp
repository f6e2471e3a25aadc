#include "expected_elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "facet_tree.h"
#include "graded_sphere.h"
#include "growth_law.h"
#include "random_facets.h"
#include "start_sizes/mesh_start_sizes.h"

namespace meshgrow {
namespace {

/// The integral of 1 / size³ over the box, outside the unit sphere, by shells of random points.
double integral_outside_sphere(const FacetTree& tree, double size_limit, double half_edge) {
  test::Random random(1);
  const double pi = std::acos(-1.0);
  double sum = 0.0;
  constexpr int shells = 60;
  constexpr int samples = 400;
  const double farthest = half_edge * std::sqrt(3.0) - 1.0;
  for (int shell = 0; shell < shells; ++shell) {
    const double inner = 1.0 + farthest * std::pow(shell / double(shells), 3.0);
    const double outer = 1.0 + farthest * std::pow((shell + 1) / double(shells), 3.0);
    const double volume = 4.0 / 3.0 * pi * (std::pow(outer, 3.0) - std::pow(inner, 3.0));
    for (int i = 0; i < samples; ++i) {
      const Vec3 p = test::random_direction(random) * test::uniform(random, inner, outer);
      if (p.cwiseAbs().maxCoeff() < half_edge) {
        sum += volume / samples / std::pow(tree.size(p, size_limit), 3.0);
      }
    }
  }
  return sum;
}

TEST(ExpectedTetrahedra, FollowTheIntegralOfSizes) {
  FacetedSource source;
  source.triangles = test::graded_sphere(3000, 5.0);
  for (const double growth_rate : {1.1, 1.2, 1.5}) {
    SizedFacets facets;
    append_mesh_start_sizes(source, QuadSize::triangles, growth_slope(growth_rate), facets);
    const double expected = 4.2 * integral_outside_sphere(FacetTree(facets), 1.0, 3.0);
    const double estimate = expected_tetrahedra(facets, 1.0, test::cube(3.0));
    EXPECT_GT(estimate, 0.5 * expected) << growth_rate;
    EXPECT_LT(estimate, 2.0 * expected) << growth_rate;
  }
}

TEST(ExpectedTetrahedra, OfOneSizeFillTheBox) {
  const SizedFacets facets = {{Facet::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0.1, 0.0}};
  const double estimate = expected_tetrahedra(facets, 0.1, test::cube(1.0));
  EXPECT_NEAR(estimate, 4.2 * 8.0 / 0.001, 0.05 * 4.2 * 8.0 / 0.001);
}

TEST(ExpectedTetrahedra, AreFiniteForAnyFacets) {
  for (const Facet& facet : {Facet::point({0, 0, 0}), Facet::segment({0, 0, 0}, {1, 0, 0}),
                             Facet::triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0})}) {
    for (const double slope : {0.0, 1e-9, 0.5}) {
      const double estimate =
          expected_tetrahedra(SizedFacets{{facet, 0.01, slope}}, 1.0, test::cube(1.0));
      EXPECT_TRUE(std::isfinite(estimate));
      EXPECT_GE(estimate, 4.2 * 8.0);
    }
  }
  EXPECT_EQ(expected_tetrahedra({}, 1.0, Box()), 0.0);
  EXPECT_NEAR(expected_tetrahedra({}, 1.0, test::cube(1.0)), 4.2 * 8.0, 1e-9);
}

}  // namespace
}  // namespace meshgrow
