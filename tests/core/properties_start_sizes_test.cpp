// Gaps and curvature turn, move and scale with the model.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "brute_force.h"
#include "growth_law.h"
#include "property_rounds.h"
#include "random_models.h"
#include "start_sizes/curvature_start_sizes.h"
#include "start_sizes/mesh_start_sizes.h"
#include "start_sizes/proximity_start_sizes.h"
#include "wall_shapes.h"

namespace meshgrow {
namespace {

using test::Random;
using test::Sources;

// ==== Shapes

/// A volume with gaps, of faces that fit together: boxes, prisms, tubes, plates with holes, and
/// spheres in each other or in boxes.
Sources random_volume(Random& random) {
  const auto some = [&random](double low, double high) { return test::uniform(random, low, high); };
  const auto cells = static_cast<int>(1 + test::random_index(random, 4));
  switch (test::random_index(random, 5)) {
    case 0:
      return test::box_faces(Vec3::Zero(), Vec3(some(0.1, 1.0), some(0.1, 1.0), some(0.02, 1.0)),
                             cells);
    case 1: {
      test::Outline outline;
      const int sides = static_cast<int>(3 + test::random_index(random, 4));
      for (const Vec3& p : test::circle(Vec3::Zero(), 1.0, sides)) {
        outline.push_back(Vec3(p.x(), some(0.1, 1.0) * p.y(), 0.0));
      }
      return test::prism(outline, some(0.05, 1.0), cells);
    }
    case 2: {
      const Vec3 centre(some(-0.5, 0.5), some(-0.5, 0.5), 0.0);
      const test::Outline hole = test::circle(centre, some(0.1, 0.4), 24);
      return test::plate_with_hole(hole, test::square_around(centre, 1.0, 24), some(0.05, 0.5));
    }
    case 3:
      return {test::sphere_face(1, Vec3::Zero(), 1.0, 2),
              test::sphere_face(2, Vec3(some(0.0, 0.3), some(0.0, 0.2), 0.0), some(0.1, 0.6), 2)};
    default:
      return test::joined(
          test::box_faces(Vec3(-1, -1, -1), Vec3(1, 1, 1), cells),
          {test::sphere_face(9, 0.2 * test::random_in_ball(random, 1.0), some(0.1, 0.75), 2)});
  }
}

/// A bent surface of a grid of triangles, or of quads, and a bent curve along it.
FacetedSource random_bent_source(Random& random) {
  const double u = test::uniform(random, 0.0, 0.5);
  const double v = test::uniform(random, 0.0, 0.5);
  const double waves = test::uniform(random, 0.5, 2.0);
  const auto at = [=](int i, int j) {
    const double x = i / 12.0;
    const double y = j / 12.0;
    return Vec3(x, y, u * std::sin(waves * 3.0 * x) + v * std::cos(waves * (2.0 * y + x)));
  };
  FacetedSource source = test::patch(1, 12, 12, at);
  if (test::random_index(random, 2) == 0) {
    source.triangles.clear();
    for (int i = 0; i < 12; ++i) {
      for (int j = 0; j < 12; ++j) {
        source.quads.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  for (int i = 0; i < 12; ++i) {
    source.segments.push_back({at(i, 5), at(i + 1, 5)});
  }
  return source;
}

struct Change {
  double scale = 1.0;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vec3 way = Vec3::Zero();

  Vec3 operator()(const Vec3& p) const { return scale * (turn * p) + way; }

  static Change of_scale(Random& random) {
    Change change;
    change.scale = std::ldexp(1.0, static_cast<int>(test::random_index(random, 61)) - 30);
    return change;
  }
  static Change of_place(Random& random) {
    Change change;
    change.scale = test::log_uniform(random, 1e-9, 1e9);
    change.turn = test::random_rotation(random);
    change.way =
        change.scale * test::log_uniform(random, 1e-3, 10.0) * test::random_direction(random);
    return change;
  }
};

void expect_equal_but_for_scale(const SizedFacets& facets, const SizedFacets& changed,
                                double scale) {
  ASSERT_EQ(changed.size(), facets.size()) << "scale " << scale;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    ASSERT_EQ(changed[i].start_size, scale * facets[i].start_size)
        << "facet " << i << ", scale " << scale;
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(changed[i].facet.corners[k], scale * facets[i].facet.corners[k])
          << "facet " << i << ", scale " << scale;
    }
  }
}

// ==== Proximity

ProximityParameters random_parameters(Random& random) {
  ProximityParameters parameters;
  parameters.cells_per_gap = test::uniform(random, 0.5, 6.0);
  parameters.growth_rate = test::random_growth_rate(random);
  parameters.size_limit = test::uniform(random, 0.2, 2.0);
  parameters.threads = 1;
  return parameters;
}

/// Its lengths multiplied.
template <typename Parameters>
Parameters scaled(Parameters parameters, double scale) {
  parameters.size_limit *= scale;
  parameters.min_size *= scale;
  return parameters;
}

SizedFacets gaps_in(const Sources& faces, const ProximityParameters& parameters,
                    double scale = 1.0) {
  SizedFacets facets;
  append_proximity_start_sizes(volume_walls(faces), test::entities_of(faces),
                               scaled(parameters, scale), facets);
  return facets;
}

TEST(ProximityProperties, ScaleToTheBitByPowersOfTwo) {
  test::for_random_rounds(12, [](Random& random) {
    const Sources faces = random_volume(random);
    const ProximityParameters parameters = random_parameters(random);
    const Change change = Change::of_scale(random);
    expect_equal_but_for_scale(gaps_in(faces, parameters),
                               gaps_in(test::moved(faces, change), parameters, change.scale),
                               change.scale);
  });
}

/// Gaps are told to 1 %, and pieces with gaps that differ by less than 5 % are not cut: where
/// rounding decides between two, the sizes in the volume still agree to a tenth.
void expect_alike(Random& random, const SizedFacets& facets, const SizedFacets& changed,
                  const ProximityParameters& parameters, const Change& change) {
  ASSERT_EQ(facets.empty(), changed.empty()) << "scale " << change.scale;
  for (int i = 0; i < 50; ++i) {
    const Vec3 p = test::random_in_box(random, test::cube(1.0));
    const double limit = change.scale * parameters.size_limit;
    const double expected = change.scale * test::brute_force_size(facets, p, parameters.size_limit);
    const double size = test::brute_force_size(changed, change(p), limit);
    ASSERT_NEAR(size, expected, 0.1 * expected) << test::text_of(p) << ", scale " << change.scale;
  }
}

TEST(ProximityProperties, TurnMoveAndScaleWithTheModel) {
  test::for_random_rounds(12, [](Random& random) {
    const Sources faces = random_volume(random);
    const ProximityParameters parameters = random_parameters(random);
    const Change change = Change::of_place(random);
    expect_alike(random, gaps_in(faces, parameters),
                 gaps_in(test::moved(faces, change), parameters, change.scale), parameters, change);
  });
}

TEST(ProximityProperties, DoNotDependOnTheOrderOfFacesAndFacets) {
  test::for_random_rounds(12, [](Random& random) {
    const Sources faces = random_volume(random);
    const ProximityParameters parameters = random_parameters(random);
    Sources changed = test::with_mixed_orientation(faces, random);
    std::shuffle(changed.begin(), changed.end(), random);
    for (FacetedSource& face : changed) {
      std::shuffle(face.triangles.begin(), face.triangles.end(), random);
    }
    expect_alike(random, gaps_in(faces, parameters), gaps_in(changed, parameters), parameters, {});
  });
}

TEST(ProximityProperties, MoreCellsAskForSmallerSizes) {
  test::for_random_rounds(40, [](Random& random) {
    const double gap = test::log_uniform(random, 1e-9, 1e9);
    const double cells = test::uniform(random, 0.1, 100.0);
    const double rate = test::random_growth_rate(random);
    const double size = gap_start_size(gap, cells, rate);
    EXPECT_LT(gap_start_size(gap, 1.01 * cells, rate), size);
    EXPECT_LT(size, gap_start_size(1.01 * gap, cells, rate));
    EXPECT_LE(gap_start_size(gap, cells, 1.01 * rate), size * (1.0 + 1e-12));
    EXPECT_NEAR(gap_start_size(1e3 * gap, cells, rate), 1e3 * size, 1e-12 * 1e3 * size);
  });
}

// ==== Curvature

SizedFacets bends_of(const FacetedSource& source, const CurvatureParameters& parameters,
                     double scale = 1.0) {
  SizedFacets facets;
  append_curvature_start_sizes(source, scaled(parameters, scale), 1.0 / 6.0, facets);
  return facets;
}

CurvatureParameters random_curvature(Random& random) {
  CurvatureParameters parameters;
  parameters.angle = test::uniform(random, 1.0, 90.0);
  parameters.min_size = test::uniform(random, 0.0, 0.01);
  parameters.size_limit = 1e6;  // so that no facet is left out by a hair
  return parameters;
}

TEST(CurvatureProperties, ScaleToTheBitByPowersOfTwo) {
  test::for_random_rounds(60, [](Random& random) {
    const FacetedSource source = random_bent_source(random);
    const CurvatureParameters parameters = random_curvature(random);
    const Change change = Change::of_scale(random);
    expect_equal_but_for_scale(
        bends_of(source, parameters),
        bends_of(test::moved({source}, change).front(), parameters, change.scale), change.scale);
  });
}

TEST(CurvatureProperties, TurnMoveAndScaleWithTheModel) {
  // Coordinates of up to ten are rounded to 1e-15; a curvature is their second difference over a
  // square of 1/12, and the flattest places here bend by 1e-6 of the others.
  test::for_random_rounds(60, [](Random& random) {
    const FacetedSource source = random_bent_source(random);
    const CurvatureParameters parameters = random_curvature(random);
    const Change change = Change::of_place(random);
    const SizedFacets facets = bends_of(source, parameters);
    const SizedFacets changed =
        bends_of(test::moved({source}, change).front(), parameters, change.scale);
    ASSERT_EQ(changed.size(), facets.size());
    for (std::size_t i = 0; i < facets.size(); ++i) {
      const double expected = change.scale * facets[i].start_size;
      ASSERT_NEAR(changed[i].start_size, expected, 1e-6 * expected)
          << "facet " << i << ", scale " << change.scale;
    }
  });
}

// ==== Meshes

TEST(MeshSizeProperties, TurnMoveAndScaleWithTheModel) {
  test::for_random_rounds(60, [](Random& random) {
    const FacetedSource source = random_bent_source(random);
    const Change change = Change::of_place(random);
    const FacetedSource moved = test::moved({source}, change).front();
    for (const QuadSize rule : {QuadSize::triangles, QuadSize::sides}) {
      SizedFacets facets;
      SizedFacets changed;
      append_mesh_start_sizes(source, rule, 0.1, facets);
      append_mesh_start_sizes(moved, rule, 0.1, changed);
      ASSERT_EQ(changed.size(), facets.size());
      for (std::size_t i = 0; i < facets.size(); ++i) {
        const double expected = change.scale * facets[i].start_size;
        ASSERT_NEAR(changed[i].start_size, expected, 1e-12 * expected) << change.scale;
      }
    }
  });
}

}  // namespace
}  // namespace meshgrow
