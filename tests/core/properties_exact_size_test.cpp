// What holds of exact sizes whatever the facets are.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "brute_force.h"
#include "facet_tree.h"
#include "property_rounds.h"
#include "random_models.h"

namespace meshgrow {
namespace {

using test::machine_epsilon;
using test::Random;
using test::RandomModel;
using test::text_of;

constexpr std::size_t most_facets = 600;

double tree_size(const FacetTree& tree, const RandomModel& model, const Vec3& p) {
  return tree.size(p, model.size_limit);
}

/// The minimum over all facets by the library's own size of one.
double least_size(const RandomModel& model, const Vec3& p) {
  double size = model.size_limit;
  for (const SizedFacet& f : model.facets) {
    size = std::min(size, f.size_at(p));
  }
  return size;
}

/// By so much may a distance be off: a distance is a difference of coordinates, and these are
/// rounded to machine_epsilon / 2 of the largest one, some times over. The size is off by less.
double rounding(const RandomModel& model, const Vec3& p, double times) {
  return times * machine_epsilon * std::max(model.reach(), p.cwiseAbs().maxCoeff());
}

TEST(ExactSizeProperties, AreTheMinimumOverAllFacetsToTheBit) {
  // Float only rules facets out; among the others double decides as here.
  test::for_random_rounds(80, [](Random& random) {
    const RandomModel model = test::random_model(random, most_facets);
    SCOPED_TRACE(model.name);
    const FacetTree tree(model.facets, 1 + static_cast<int>(test::random_index(random, 2)));
    const std::vector<Vec3> points = test::random_points(random, model, 150);
    std::vector<double> sizes(points.size());
    tree.sizes(points.data(), points.size(), model.size_limit, sizes.data());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double expected = least_size(model, points[i]);
      ASSERT_EQ(tree_size(tree, model, points[i]), expected) << text_of(points[i]);
      ASSERT_EQ(sizes[i], expected) << "of many, " << text_of(points[i]);
    }
  });
}

/// Facets that all touch one sphere and have one start size, to a millionth or to the last digits:
/// from near its centre float cannot tell which is the smallest. Others lie around, far away.
RandomModel facets_around(Random& random, const Vec3& centre, double radius) {
  RandomModel model;
  const double difference = test::log_uniform(random, 1e-16, 1e-6);
  const auto nearly = [&](double x) { return x * (1.0 + test::uniform(random, 0.0, difference)); };
  const double start_size = radius * test::log_uniform(random, 1e-3, 1.0);
  const double slope = test::uniform(random, 0.05, 0.9);
  for (std::size_t i = 1 + test::random_index(random, 40); i > 0; --i) {
    const Vec3 normal = test::random_direction(random);
    const Vec3 foot = centre + nearly(radius) * normal;
    const Vec3 along = normal.cross(test::random_direction(random)).normalized();
    const Vec3 across = normal.cross(along);
    const double size = radius * test::log_uniform(random, 1e-3, 10.0);
    const std::array<Facet, 3> facets = {
        Facet::point(foot), Facet::segment(foot - size * along, foot + 0.3 * size * along),
        Facet::triangle(foot - size * along, foot + size * (along - across),
                        foot + size * (along + across))};
    // So many that a block or a node has them alone, and its box is no larger than the facet.
    const std::size_t copies = test::one_of(random, std::array<std::size_t, 3>{1, 8, 64});
    model.facets.insert(model.facets.end(), copies,
                        {test::one_of(random, facets), nearly(start_size), slope});
  }
  const double farthest = test::log_uniform(random, 1.0, 1e3);
  for (std::size_t i = test::random_index(random, 20); i > 0; --i) {
    const Vec3 p = centre + farthest * test::random_direction(random);
    model.facets.push_back({Facet::point(p), start_size, slope});
  }
  std::shuffle(model.facets.begin(), model.facets.end(), random);
  return model;
}

TEST(ExactSizeProperties, AreTheMinimumOfManyFacetsThatAreAllButEqual) {
  test::for_random_rounds(300, [](Random& random) {
    const Vec3 centre = test::random_in_box(random, test::cube(1.0));
    const double radius = test::log_uniform(random, 1e-4, 1.0);
    RandomModel model = facets_around(random, centre, radius);
    model.size_limit = 1e22;
    const FacetTree tree(model.facets);
    for (int i = 0; i < 50; ++i) {
      const Vec3 p =
          centre + test::random_in_ball(random, radius * test::log_uniform(random, 1e-15, 1e-4));
      ASSERT_EQ(tree_size(tree, model, p), least_size(model, p)) << text_of(p);
    }
  });
}

TEST(ExactSizeProperties, EqualTheReferenceInExtendedPrecision) {
  test::for_random_rounds(100, [](Random& random) {
    const RandomModel model = test::random_model(random, 60);
    SCOPED_TRACE(model.name);
    const FacetTree tree(model.facets);
    for (const Vec3& p : test::random_points(random, model, 20)) {
      const double expected = test::reference_size(model.facets, p, model.size_limit);
      ASSERT_NEAR(tree_size(tree, model, p), expected, 1e-12 * expected + rounding(model, p, 4.0))
          << text_of(p);
    }
  });
}

TEST(ExactSizeProperties, ChangeByNoMoreThanTheSlopeTimesTheWay) {
  test::for_random_rounds(400, [](Random& random) {
    const RandomModel model = test::random_model(random, most_facets);
    SCOPED_TRACE(model.name);
    const FacetTree tree(model.facets);
    const double slope = model.largest_slope();
    for (const Vec3& p : test::random_points(random, model, 100)) {
      const double way = test::log_uniform(random, 1e-12, 10.0) * model.reach();
      const Vec3 q = test::random_index(random, 2) == 0
                         ? Vec3(p + way * test::random_direction(random))
                         : test::random_point(random, model);
      const double at_p = tree_size(tree, model, p);
      const double at_q = tree_size(tree, model, q);
      // Both distances and both sums are rounded.
      const double allowed = slope * (1.0 + 4.0 * machine_epsilon) * (p - q).norm() +
                             8.0 * machine_epsilon * std::max(at_p, at_q) +
                             slope * (rounding(model, p, 8.0) + rounding(model, q, 8.0));
      ASSERT_LE(std::abs(at_p - at_q), allowed) << text_of(p) << " and " << text_of(q);
    }
  });
}

// ==== Invariance

TEST(ExactSizeProperties, DoNotDependOnTheOrderOrRepetitionOfFacets) {
  test::for_random_rounds(300, [](Random& random) {
    const RandomModel model = test::random_model(random, most_facets);
    SCOPED_TRACE(model.name);
    RandomModel changed = model;
    for (std::size_t i = test::random_index(random, 2 * model.facets.size()); i > 0; --i) {
      changed.facets.push_back(model.facets[test::random_index(random, model.facets.size())]);
    }
    std::shuffle(changed.facets.begin(), changed.facets.end(), random);
    const FacetTree tree(model.facets);
    const FacetTree other(changed.facets);
    for (const Vec3& p : test::random_points(random, model, 100)) {
      ASSERT_EQ(tree_size(other, model, p), tree_size(tree, model, p)) << text_of(p);
    }
  });
}

TEST(ExactSizeProperties, ScaleWithTheModelToTheBitByPowersOfTwo) {
  // A power of two changes no digit of any product, sum or root: 2^±30 is 1e±9 model units.
  test::for_random_rounds(300, [](Random& random) {
    const RandomModel model = test::random_model(random, most_facets);
    SCOPED_TRACE(model.name);
    const double scale = std::ldexp(1.0, static_cast<int>(test::random_index(random, 61)) - 30);
    const RandomModel changed = test::mapped(
        model, [=](const Vec3& p) { return Vec3(scale * p); }, scale);
    const FacetTree tree(model.facets);
    const FacetTree other(changed.facets);
    for (const Vec3& p : test::random_points(random, model, 100)) {
      ASSERT_EQ(tree_size(other, changed, scale * p), scale * tree_size(tree, model, p))
          << text_of(p) << ", scale " << scale;
    }
  });
}

/// Sizes before and after a change of place and scale. Corners and points move by rounding, and a
/// distance to a convex facet changes by no more than they do: each coordinate after a rotation is
/// a sum of three products, whose factors are rounded themselves. 1e-12 is what distances keep.
template <typename Map>
void expect_same_sizes(Random& random, const RandomModel& model, Map map, double scale) {
  const RandomModel changed = test::mapped(model, map, scale);
  const FacetTree tree(model.facets);
  const FacetTree other(changed.facets);
  for (const Vec3& p : test::random_points(random, model, 100)) {
    const double expected = scale * tree_size(tree, model, p);
    const double allowed =
        2e-12 * expected + scale * rounding(model, p, 20.0) + rounding(changed, map(p), 20.0);
    ASSERT_NEAR(tree_size(other, changed, map(p)), expected, allowed)
        << text_of(p) << ", scale " << scale;
  }
}

TEST(ExactSizeProperties, ScaleWithTheModel) {
  test::for_random_rounds(300, [](Random& random) {
    const RandomModel model = test::random_model(random, most_facets);
    SCOPED_TRACE(model.name);
    const double scale = test::log_uniform(random, 1e-9, 1e9);
    expect_same_sizes(
        random, model, [=](const Vec3& p) { return Vec3(scale * p); }, scale);
  });
}

TEST(ExactSizeProperties, MoveWithTheModel) {
  test::for_random_rounds(300, [](Random& random) {
    const RandomModel model = test::random_model(random, most_facets);
    SCOPED_TRACE(model.name);
    const Vec3 way = test::log_uniform(random, 1e-3, 1e9) * test::random_direction(random);
    expect_same_sizes(
        random, model, [=](const Vec3& p) { return Vec3(p + way); }, 1.0);
  });
}

TEST(ExactSizeProperties, TurnWithTheModel) {
  test::for_random_rounds(300, [](Random& random) {
    const RandomModel model = test::random_model(random, most_facets);
    SCOPED_TRACE(model.name);
    const Eigen::Matrix3d turn = test::random_rotation(random);
    expect_same_sizes(
        random, model, [=](const Vec3& p) { return Vec3(turn * p); }, 1.0);
  });
}

// ==== Monotonicity

TEST(ExactSizeProperties, RiseWithStartSizesGrowthRatesAndLimit) {
  // Sums, products and minima keep their order in spite of rounding, so no tolerance is needed.
  test::for_random_rounds(300, [](Random& random) {
    const RandomModel model = test::random_model(random, most_facets);
    SCOPED_TRACE(model.name);
    RandomModel larger = model;
    const std::size_t what = test::random_index(random, 4);
    for (SizedFacet& f : larger.facets) {
      if (test::random_index(random, 2) == 0) {
        continue;
      }
      if (what == 0 || what == 3) {
        f.start_size *= test::uniform(random, 1.0, 2.0);
      }
      if (what == 1 || what == 3) {
        const double growth_rate = 1.0 / (1.0 - f.slope) * test::uniform(random, 1.0 + 1e-9, 1.5);
        f.slope = std::max(f.slope, growth_slope(growth_rate));
      }
    }
    if (what == 2 || what == 3) {
      larger.size_limit *= test::uniform(random, 1.0, 3.0);
    }
    const FacetTree tree(model.facets);
    const FacetTree other(larger.facets);
    for (const Vec3& p : test::random_points(random, model, 100)) {
      ASSERT_GE(tree_size(other, larger, p), tree_size(tree, model, p))
          << text_of(p) << ", change " << what;
    }
  });
}

}  // namespace
}  // namespace meshgrow
