#include "facet_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "brute_force.h"
#include "random_facets.h"

namespace meshgrow {
namespace {

using test::FacetMix;
using test::Random;
using test::RandomFacets;

/// "seed 7, query 12 at (1 2 3)"
std::string query_text(unsigned seed, int query, const Vec3& p) {
  std::ostringstream text;
  text.precision(17);
  text << "seed " << seed << ", query " << query << " at (" << p.transpose() << ")";
  return text.str();
}

// ==== Sizes

class FacetTreeOf : public testing::TestWithParam<FacetMix> {};

TEST_P(FacetTreeOf, SizeEqualsBruteForce) {
  // Triangles with many facets, since they are most of what comes; the others with fewer.
  struct Round {
    std::size_t facets;
    int queries;
  };
  const std::vector<Round> rounds = GetParam() == FacetMix::triangles
                                        ? std::vector<Round>{{1000, 100000}, {2, 1000}, {5, 1000}}
                                        : std::vector<Round>{{250, 100000}, {3, 1000}, {9, 1000}};
  unsigned seed = 100;
  for (const Round& round : rounds) {
    Random random(++seed);
    RandomFacets wanted;
    wanted.mix = GetParam();
    wanted.count = round.facets;
    SizedFacets facets = test::random_facets(random, wanted);
    facets.front().slope = 0.0;  // growth rate 1 among others; large, or it would rule everywhere
    facets.front().start_size = 0.1;
    const FacetTree tree(facets);
    for (int i = 0; i < round.queries; ++i) {
      const Vec3 p = test::random_query(random, facets, wanted.box);
      const double expected = test::brute_force_size(facets, p);
      ASSERT_NEAR(tree.size(p), expected, 1e-12 * expected) << query_text(seed, i, p);
    }
  }
}

TEST_P(FacetTreeOf, ManyFacetsRuleSomewhere) {
  // Guards the tests around it: they would show little if one small facet ruled everywhere.
  Random random(150);
  RandomFacets wanted;
  wanted.mix = GetParam();
  wanted.count = 250;
  const SizedFacets facets = test::random_facets(random, wanted);
  std::set<std::size_t> ruling;
  int not_the_nearest = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = test::random_query(random, facets, wanted.box);
    std::size_t smallest = 0;
    std::size_t nearest = 0;
    for (std::size_t k = 0; k < facets.size(); ++k) {
      smallest = facets[k].size_at(p) < facets[smallest].size_at(p) ? k : smallest;
      const bool nearer = distance(facets[k].facet, p) < distance(facets[nearest].facet, p);
      nearest = nearer ? k : nearest;
    }
    ruling.insert(smallest);
    not_the_nearest += smallest != nearest ? 1 : 0;
  }
  EXPECT_GT(ruling.size(), 50u);
  EXPECT_GT(not_the_nearest, 200);
}

TEST_P(FacetTreeOf, SizeEqualsTheReferenceInExtendedPrecision) {
  constexpr unsigned seed = 200;
  Random random(seed);
  RandomFacets wanted;
  wanted.mix = GetParam();
  wanted.count = 60;
  const SizedFacets facets = test::random_facets(random, wanted);
  const FacetTree tree(facets);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = test::random_query(random, facets, wanted.box);
    const double expected = test::reference_size(facets, p);
    // Coordinates round as well: by so much can a distance close to zero be off.
    const double rounding = 1e-15 * std::max(1.5, p.cwiseAbs().maxCoeff());
    ASSERT_NEAR(tree.size(p), expected, 1e-12 * expected + rounding) << query_text(seed, i, p);
  }
}

TEST_P(FacetTreeOf, SizeWithOneSlopeEqualsBruteForce) {
  // One growth rate, as in most models; sizes that vary little and much.
  for (const double largest_size : {2e-3, 1.0}) {
    constexpr unsigned seed = 300;
    Random random(seed);
    RandomFacets wanted;
    wanted.mix = GetParam();
    wanted.count = 400;
    wanted.smallest_size = 1e-3;
    wanted.largest_size = largest_size;
    wanted.slopes = {1.0 / 6.0};
    const SizedFacets facets = test::random_facets(random, wanted);
    const FacetTree tree(facets);
    for (int i = 0; i < 5000; ++i) {
      const Vec3 p = test::random_query(random, facets, wanted.box);
      const double expected = test::brute_force_size(facets, p);
      ASSERT_NEAR(tree.size(p), expected, 1e-12 * expected) << query_text(seed, i, p);
    }
  }
}

TEST_P(FacetTreeOf, ClosestFacetEqualsBruteForce) {
  constexpr unsigned seed = 400;
  Random random(seed);
  RandomFacets wanted;
  wanted.mix = GetParam();
  wanted.count = 300;
  const FacetTree tree(test::random_facets(random, wanted));
  const SizedFacets& facets = tree.facets();
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = test::random_query(random, facets, wanted.box);
    double expected = FacetTree::infinity;
    for (const SizedFacet& facet : facets) {
      expected = std::min(expected, distance(facet.facet, p));
    }
    const FacetTree::Closest closest = tree.closest_facet(p);
    ASSERT_NEAR(closest.distance, expected, 1e-12 * expected) << query_text(seed, i, p);
    ASSERT_LT(closest.facet, facets.size());
    // Of facets at the same distance, any may be named.
    ASSERT_NEAR(distance(facets[closest.facet].facet, p), expected, 1e-12 * expected)
        << query_text(seed, i, p);
  }
}

TEST_P(FacetTreeOf, UpperBoundIsAnsweredWhereNothingIsBelowIt) {
  constexpr unsigned seed = 500;
  Random random(seed);
  RandomFacets wanted;
  wanted.mix = GetParam();
  wanted.count = 100;
  const FacetTree tree(test::random_facets(random, wanted));
  int bounded = 0;
  int below = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = test::random_query(random, tree.facets(), wanted.box);
    const double size = tree.size(p);
    const double bound = size * test::log_uniform(random, 0.1, 10.0);
    ASSERT_EQ(tree.size(p, bound), std::min(bound, size)) << query_text(seed, i, p);
    ASSERT_EQ(tree.size(p, size), size);
    (bound < size ? bounded : below) += 1;
  }
  EXPECT_GT(bounded, 1000);
  EXPECT_GT(below, 1000);
}

INSTANTIATE_TEST_SUITE_P(Mixes, FacetTreeOf,
                         testing::Values(FacetMix::points, FacetMix::segments, FacetMix::triangles,
                                         FacetMix::mixed, FacetMix::degenerate),
                         [](const testing::TestParamInfo<FacetMix>& param_info) {
                           return test::mix_name(param_info.param);
                         });

TEST(FacetTree, SizeEqualsBruteForceFarFromTheOrigin) {
  constexpr unsigned seed = 600;
  Random random(seed);
  RandomFacets wanted;
  wanted.count = 300;
  wanted.smallest_size = 1e-3;
  const Vec3 offset(1e8, -1e8, 3e7);
  wanted.box = Box(offset - Vec3::Ones(), offset + Vec3::Ones());
  const SizedFacets facets = test::random_facets(random, wanted);
  const FacetTree tree(facets);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = test::random_query(random, facets, wanted.box);
    const double expected = test::brute_force_size(facets, p);
    // The corners of boxes and the feet on facets are rounded to 1.5e-8 there.
    ASSERT_NEAR(tree.size(p), expected, 1e-12 * expected + 1e-7) << query_text(seed, i, p);
  }
}

TEST(FacetTree, SmallFacetFurtherAwayRulesOverTheNearest) {
  const double slope = 0.2;
  const SizedFacets facets = {{Facet::segment({1, -1, 0}, {1, 1, 0}), 1.0, slope},
                              {Facet::segment({-3, -1, 0}, {-3, 1, 0}), 0.1, slope}};
  const FacetTree tree(facets);
  EXPECT_DOUBLE_EQ(tree.size({0, 0, 0}), 0.1 + slope * 3.0);
  const FacetTree::Closest closest = tree.closest_facet({0, 0, 0});
  EXPECT_DOUBLE_EQ(closest.distance, 1.0);
  EXPECT_EQ(tree.facets()[closest.facet].start_size, 1.0);
}

TEST(FacetTree, SmallFacetBehindThousandsOfNearerOnesRules) {
  SizedFacets facets;
  for (int i = 0; i < 2000; ++i) {
    const double x = 0.001 * i;
    facets.push_back({Facet::segment({x, 1, 0}, {x + 0.001, 1, 0}), 1.0, 0.1});
  }
  facets.push_back({Facet::point({1, -5, 0}), 1e-3, 0.1});
  const FacetTree tree(facets);
  EXPECT_DOUBLE_EQ(tree.size({1, 0, 0}), 1e-3 + 0.5);
  EXPECT_DOUBLE_EQ(tree.closest_facet({1, 0, 0}).distance, 1.0);
}

TEST(FacetTree, GentlerSlopeRulesFarAway) {
  // Near the facets the small start size rules, far away the gentle slope.
  const FacetTree tree({{Facet::point({0, 0, 0}), 0.1, 0.5}, {Facet::point({0, 0, 0}), 1.0, 0.1}});
  EXPECT_DOUBLE_EQ(tree.size({0, 0, 1}), 0.6);
  EXPECT_DOUBLE_EQ(tree.size({0, 0, 10}), 2.0);
}

// ==== Special sets of facets

TEST(FacetTree, EmptyTree) {
  const FacetTree tree({});
  EXPECT_TRUE(tree.empty());
  EXPECT_TRUE(tree.facets().empty());
  EXPECT_EQ(tree.size({1, 2, 3}), FacetTree::infinity);
  EXPECT_EQ(tree.size({1, 2, 3}, 4.0), 4.0);
  EXPECT_EQ(tree.closest_facet({1, 2, 3}).distance, FacetTree::infinity);
}

TEST(FacetTree, OneFacet) {
  const FacetTree tree({{Facet::segment({0, 0, 0}, {2, 0, 0}), 0.5, 0.25}});
  EXPECT_FALSE(tree.empty());
  EXPECT_DOUBLE_EQ(tree.size({1, 4, 0}), 1.5);
  EXPECT_DOUBLE_EQ(tree.size({1, 0, 0}), 0.5);
  EXPECT_EQ(tree.size({1, 4, 0}, 1.25), 1.25);
  EXPECT_EQ(tree.size({1, 4, 0}, 0.25), 0.25);
  const FacetTree::Closest closest = tree.closest_facet({5, 4, 0});
  EXPECT_EQ(closest.facet, 0u);
  EXPECT_DOUBLE_EQ(closest.distance, 5.0);
}

TEST(FacetTree, TenThousandIdenticalFacets) {
  const SizedFacet facet{Facet::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0.3, 0.2};
  const FacetTree tree(SizedFacets(10000, facet));
  constexpr unsigned seed = 700;
  Random random(seed);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = test::random_in_box(random, test::cube(3.0));
    ASSERT_DOUBLE_EQ(tree.size(p), facet.size_at(p)) << query_text(seed, i, p);
    ASSERT_DOUBLE_EQ(tree.closest_facet(p).distance, distance(facet.facet, p));
  }
}

TEST(FacetTree, CoincidentFacetsOfDifferentSizes) {
  constexpr unsigned seed = 800;
  Random random(seed);
  SizedFacets facets;
  for (int i = 0; i < 3000; ++i) {
    facets.push_back({Facet::segment({0, 0, 0}, {1, 0, 0}), test::log_uniform(random, 1e-3, 1.0),
                      test::uniform(random, 0.0, 0.9)});
  }
  const FacetTree tree(facets);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = test::random_in_box(random, test::cube(10.0));
    const double expected = test::brute_force_size(facets, p);
    ASSERT_NEAR(tree.size(p), expected, 1e-12 * expected) << query_text(seed, i, p);
  }
}

/// Positions of facets in orders that make careless trees deep.
class FacetTreeSorted : public testing::TestWithParam<std::string> {
 protected:
  static std::vector<double> positions() {
    constexpr int count = 100000;
    std::vector<double> x;
    for (int i = 0; i < count; ++i) {
      x.push_back(static_cast<double>(i) / count);
    }
    const std::string order = GetParam();
    if (order == "Descending") {
      std::reverse(x.begin(), x.end());
    } else if (order == "OrganPipe") {
      std::reverse(x.begin() + count / 2, x.end());
    } else if (order == "Halving") {
      // Geometric: splitting space in the middle would peel facets off one by one.
      for (int i = 0; i < count; ++i) {
        x[i] = std::pow(0.5, 1000.0 * i / count);
      }
    } else if (order == "TwoPlaces") {
      for (int i = 0; i < count; ++i) {
        x[i] = i == 0 ? 1.0 : 0.0;
      }
    }
    return x;
  }
};

TEST_P(FacetTreeSorted, SizeEqualsBruteForce) {
  constexpr unsigned seed = 900;
  Random random(seed);
  SizedFacets facets;
  for (const double x : positions()) {
    facets.push_back(
        {Facet::segment({x, 0, 0}, {x, 0, 1e-3}), test::log_uniform(random, 1e-3, 1e-1), 0.2});
  }
  const FacetTree tree(facets);
  ASSERT_EQ(tree.facets().size(), facets.size());
  for (int i = 0; i < 60; ++i) {
    const Vec3 p(test::uniform(random, -0.5, 1.5), test::log_uniform(random, 1e-6, 1.0), 0.0);
    const double expected = test::brute_force_size(facets, p);
    ASSERT_NEAR(tree.size(p), expected, 1e-12 * expected) << query_text(seed, i, p);
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, FacetTreeSorted,
                         testing::Values("Ascending", "Descending", "OrganPipe", "Halving",
                                         "TwoPlaces"),
                         [](const testing::TestParamInfo<std::string>& param_info) {
                           return param_info.param;
                         });

TEST(FacetTree, FacetsAreReorderedButNeitherLostNorChanged) {
  constexpr unsigned seed = 1000;
  Random random(seed);
  RandomFacets wanted;
  wanted.count = 777;
  const SizedFacets facets = test::random_facets(random, wanted);
  const FacetTree tree(facets);
  const auto sorted = [](SizedFacets unsorted) {
    std::sort(unsorted.begin(), unsorted.end(),
              [](const SizedFacet& a, const SizedFacet& b) { return a.start_size < b.start_size; });
    return unsorted;
  };
  const SizedFacets before = sorted(facets);
  const SizedFacets after = sorted(tree.facets());
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_EQ(after[i].start_size, before[i].start_size) << "seed " << seed;
    ASSERT_EQ(after[i].slope, before[i].slope);
    ASSERT_EQ(after[i].facet.corner_count, before[i].facet.corner_count);
    ASSERT_EQ(after[i].facet.corners, before[i].facet.corners);
  }
  EXPECT_GE(tree.memory_bytes(), facets.size() * sizeof(SizedFacet));
}

TEST(FacetTree, NeighboursInSpaceAreNeighboursInOrder) {
  // The promise of facets(): what comes in shuffled is stored near its neighbours.
  SizedFacets facets;
  for (int i = 0; i < 4096; ++i) {
    facets.push_back({Facet::point({(i * 2654435761u % 4096u) / 4096.0, 0, 0}), 1.0, 0.1});
  }
  const FacetTree tree(facets);
  double gaps = 0.0;
  for (std::size_t i = 1; i < facets.size(); ++i) {
    gaps += (tree.facets()[i].facet.centroid() - tree.facets()[i - 1].facet.centroid()).norm();
  }
  EXPECT_LT(gaps, 10.0);  // in sorted order 1, shuffled about 1400
}

}  // namespace
}  // namespace meshgrow
