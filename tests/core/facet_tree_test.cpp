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
  const SizedFacets facets(tree.facets().begin(), tree.facets().end());
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

TEST_P(FacetTreeOf, ClosestAmongSomeFacetsEqualsBruteForce) {
  constexpr unsigned seed = 550;
  Random random(seed);
  RandomFacets wanted;
  wanted.mix = GetParam();
  wanted.count = 300;
  const FacetTree tree(test::random_facets(random, wanted));
  const SizedFacets facets(tree.facets().begin(), tree.facets().end());
  const std::vector<double> largest_below = tree.node_values<double>(
      [&](std::size_t i) { return facets[i].start_size; },
      [](double& largest, double other) { largest = std::max(largest, other); });
  int none = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = test::random_query(random, facets, wanted.box);
    const double smallest = test::log_uniform(random, 1e-6, 1.0);
    const double within = test::log_uniform(random, 0.01, 10.0);
    const auto accepts = [&](std::size_t k) { return facets[k].start_size >= smallest; };
    double expected = within;
    for (std::size_t k = 0; k < facets.size(); ++k) {
      expected = accepts(k) ? std::min(expected, distance(facets[k].facet, p)) : expected;
    }
    const auto distance_to = [&](std::size_t k) {
      return accepts(k) ? distance(facets[k].facet, p) : FacetTree::infinity;
    };
    const FacetTree::Closest closest = tree.closest_facet(p, within, distance_to);
    ASSERT_NEAR(closest.distance, expected, 1e-12 * expected) << query_text(seed, i, p);
    ASSERT_EQ(closest.facet == facets.size(), expected == within) << query_text(seed, i, p);
    ASSERT_TRUE(expected == within || accepts(closest.facet)) << query_text(seed, i, p);
    none += expected == within ? 1 : 0;
    // By a bound of the caller's own.
    const FacetTree::Closest by_nodes = tree.closest_facet(
        within,
        [&](std::size_t node, const Box& box) {
          return largest_below[node] >= smallest ? 0.5 * box.exteriorDistance(p)
                                                 : FacetTree::infinity;
        },
        distance_to);
    ASSERT_NEAR(by_nodes.distance, expected, 1e-12 * expected) << query_text(seed, i, p);
  }
  EXPECT_GT(none, 100);
  EXPECT_LT(none, 4900);
}

TEST_P(FacetTreeOf, OriginalIndexTellsWhereFacetsStood) {
  Random random(560);
  RandomFacets wanted;
  wanted.mix = GetParam();
  wanted.count = 333;
  const SizedFacets before = test::random_facets(random, wanted);
  const FacetTree tree(before);
  std::set<std::size_t> seen;
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_TRUE(tree.facets()[i] == before[tree.original_index(i)]);
    seen.insert(tree.original_index(i));
  }
  EXPECT_EQ(seen.size(), before.size());
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

TEST(FacetTree, SizeEqualsBruteForceForAnyNumberOfFacets) {
  // Around what fills blocks, nodes and pieces of parallel work.
  for (const std::size_t full : {8u, 64u, 512u, 4096u, 8192u, 32768u}) {
    for (const std::size_t count : {full - 1, full, full + 1, full + 8, full + 9, full + 64 + 1}) {
      const unsigned seed = 700 + static_cast<unsigned>(count);
      Random random(seed);
      RandomFacets wanted;
      wanted.mix = FacetMix::triangles;
      wanted.count = count;
      wanted.smallest_size = 1e-2;
      SizedFacets facets = test::random_facets(random, wanted);
      const FacetTree tree(facets, 2);
      ASSERT_EQ(tree.facets().size(), count);
      for (int i = 0; i < 20; ++i) {
        const Vec3 p = test::random_query(random, facets, wanted.box);
        const double expected = test::brute_force_size(facets, p);
        ASSERT_NEAR(tree.size(p), expected, 1e-12 * expected) << query_text(seed, i, p);
      }
      // The last facet rules where it alone is small.
      facets.back().start_size = 1e-6;
      const Vec3 corner = facets.back().facet.corners[0];
      ASSERT_NEAR(FacetTree(facets).size(corner), 1e-6, 1e-12) << "seed " << seed;
    }
  }
}

TEST(FacetTree, StartSizesBeyondAllMeasureLeaveTheOthersAsTheyAre) {
  // A limit of 1e22, as Gmsh has it, is the start size of whatever is flat.
  for (const double huge : {1e12, 1e22, 1e60, 1e300}) {
    constexpr unsigned seed = 620;
    Random random(seed);
    RandomFacets wanted;
    wanted.count = 300;
    SizedFacets facets = test::random_facets(random, wanted);
    for (std::size_t i = 0; i < facets.size(); i += 3) {
      facets[i].start_size = huge;
    }
    const FacetTree tree(facets);
    EXPECT_LT(tree.unit(), 10.0);
    for (int i = 0; i < 500; ++i) {
      const Vec3 p = test::random_query(random, facets, wanted.box);
      const double expected = test::brute_force_size(facets, p);
      ASSERT_NEAR(tree.size(p), expected, 1e-12 * expected) << query_text(seed, i, p);
    }
    for (SizedFacet& facet : facets) {
      facet.start_size = huge;
    }
    const Vec3 p(0.1, 0.2, 0.3);
    ASSERT_NEAR(FacetTree(facets).size(p), test::brute_force_size(facets, p), 1e-12 * huge);
  }
}

TEST(FacetTree, AFacetBeyondAllMeasureLeavesTheOthersAsTheyAre) {
  // As when one node of a mesh is garbage: in units of all facets the others are nothing in float.
  for (const double far : {1e9, 1e13, 1e17, 1e30, 1e100, 1e300}) {
    SCOPED_TRACE(far);
    SizedFacets facets;
    for (int i = 0; i < 40; ++i) {
      const int row = i / 4;
      facets.push_back({Facet::point({0.25 * (i % 4), 0.25 * row, 0.0}), 0.1 + 0.01 * i, 0.2});
    }
    facets.push_back({Facet::triangle({0, far, 0}, {0, 1, 0}, {1, 0, -far}), 0.2, 0.2});
    const FacetTree tree(facets);
    for (int i = 0; i < 40; ++i) {
      const Vec3 p(0.07 * (i % 13), 0.11 * (i % 7), 0.05 * i);
      double expected = FacetTree::infinity;
      for (const SizedFacet& facet : facets) {
        expected = std::min(expected, facet.size_at(p));
      }
      ASSERT_NEAR(tree.size(p), expected, 1e-12 * expected) << i;
      double size = 0.0;
      tree.sizes(&p, 1, FacetTree::infinity, &size);
      ASSERT_EQ(size, tree.size(p));
    }
  }
}

TEST(FacetTree, FacetsAsShortAsNothingArePoints) {
  for (const double length : {1e-80, 1e-100, 1e-155, 1e-161, 1e-163}) {
    constexpr unsigned seed = 630;
    Random random(seed);
    SizedFacets facets;
    for (int i = 0; i < 64; ++i) {
      const Vec3 far = Vec3(1, 0, 0) + 0.3 * test::random_direction(random);
      const Vec3 b = length * test::random_direction(random);
      facets.push_back({i % 2 == 0 ? Facet::point(far) : Facet::segment({0, 0, 0}, b),
                        i % 2 == 0 ? 3e-2 : 1e-3, 0.3});
    }
    const FacetTree tree(facets);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = test::random_in_box(random, test::cube(1.0));
      const double expected = test::brute_force_size(facets, p);
      ASSERT_NEAR(tree.size(p), expected, 1e-12 * expected) << query_text(seed, i, p);
    }
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
  const FacetTree tree(SizedFacets{});
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
  const SizedFacets after = sorted({tree.facets().begin(), tree.facets().end()});
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

TEST(FacetTree, NodeValuesOfTheFirstNodeAreOfAllFacets) {
  Random random(1050);
  for (const std::size_t count : {1u, 4u, 5u, 777u}) {
    RandomFacets wanted;
    wanted.count = count;
    const FacetTree tree(test::random_facets(random, wanted));
    const auto counts = tree.node_values<std::size_t>(
        [](std::size_t) { return 1; }, [](std::size_t& sum, std::size_t other) { sum += other; });
    ASSERT_FALSE(counts.empty());
    EXPECT_EQ(counts.front(), count);
    // Every node that a search meets has its value.
    std::size_t met = 0;
    tree.closest_facet(
        FacetTree::infinity,
        [&](std::size_t node, const Box&) {
          ++met;
          EXPECT_GT(counts.at(node), 0u);
          EXPECT_LE(counts.at(node), count);
          return 0.0;
        },
        [](std::uint32_t) { return FacetTree::infinity; });
    EXPECT_GE(met, count / 8);
  }
}

// ==== Rays

/// Compares first_hit with all facets one by one; any facet at the same distance may be named.
void compare_first_hit(const FacetTree& tree, const Vec3& origin, const Vec3& direction,
                       double within, std::size_t modulus, const std::string& text) {
  const SizedFacets facets(tree.facets().begin(), tree.facets().end());
  const auto accepts = [&](std::size_t i) { return tree.original_index(i) % modulus != 0; };
  double expected = within;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    if (accepts(i)) {
      expected = std::min(expected, ray_distance(facets[i].facet, origin, direction));
    }
  }
  const FacetTree::Closest hit = tree.first_hit(origin, direction, within, accepts);
  ASSERT_EQ(hit.distance, expected) << text;
  ASSERT_EQ(hit.facet == facets.size(), expected == within) << text;
  if (hit.facet < facets.size()) {
    ASSERT_TRUE(accepts(hit.facet)) << text;
    ASSERT_EQ(ray_distance(facets[hit.facet].facet, origin, direction), expected) << text;
  }
}

TEST(FacetTree, FirstHitEqualsBruteForce) {
  for (const FacetMix mix : {FacetMix::triangles, FacetMix::mixed, FacetMix::degenerate}) {
    constexpr unsigned seed = 1100;
    Random random(seed);
    RandomFacets wanted;
    wanted.mix = mix;
    wanted.count = 500;
    const FacetTree tree(test::random_facets(random, wanted));
    for (int i = 0; i < 5000; ++i) {
      const Vec3 origin = test::random_query(random, tree.facets(), wanted.box);
      Vec3 direction = test::random_direction(random);
      if (i % 3 == 0) {
        const std::size_t at = test::random_index(random, tree.facets().size());
        direction =
            (test::random_on_facet(random, tree.facets()[at].facet) - origin).stableNormalized();
      } else if (i % 3 == 1) {
        direction = Vec3::Zero();
        direction[i % 9 / 3] = i % 2 == 0 ? 1.0 : -1.0;
      }
      if (direction.norm() > 0.5) {
        const double within =
            i % 4 == 0 ? FacetTree::infinity : test::log_uniform(random, 0.1, 10.0);
        compare_first_hit(tree, origin, direction, within, 2 + i % 5, query_text(seed, i, origin));
      }
    }
  }
}

/// The surface of the cube from −1 to 1 in n × n cells a side, each of two triangles.
SizedFacets cube_surface(int n) {
  SizedFacets facets;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto at = [&](int i, int j) {
        Vec3 p;
        p[axis] = side;
        p[(axis + 1) % 3] = -1.0 + 2.0 * i / n;
        p[(axis + 2) % 3] = -1.0 + 2.0 * j / n;
        return p;
      };
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          facets.push_back({Facet::triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1)), 1.0, 0.1});
          facets.push_back({Facet::triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1)), 1.0, 0.1});
        }
      }
    }
  }
  return facets;
}

TEST(FacetTree, RaysAlongAxesAndBoxSidesHit) {
  // From grid points, so that rays run along sides of boxes and through corners of triangles.
  constexpr int n = 4;
  const FacetTree tree(cube_surface(n));
  const auto all = [](std::size_t) { return true; };
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1.0, 1.0}) {
          for (const double height : {0.0, 0.3, -1.0, 5.0}) {
            Vec3 origin;
            origin[axis] = -sign * height;
            origin[(axis + 1) % 3] = -1.0 + 2.0 * i / n;
            origin[(axis + 2) % 3] = -1.0 + 2.0 * j / n;
            Vec3 direction = Vec3::Zero();
            direction[axis] = sign;
            const double expected = height == 5.0 ? 4.0 : height == -1.0 ? 0.0 : 1.0 + height;
            const FacetTree::Closest hit =
                tree.first_hit(origin, direction, FacetTree::infinity, all);
            ASSERT_EQ(hit.distance, expected) << origin.transpose() << " axis " << axis;
            compare_first_hit(tree, origin, direction, 10.0, 3, "grid");
          }
        }
      }
    }
  }
}

TEST(FacetTree, NoRaySlipsOutOfAClosedSurface) {
  for (const double offset : {0.0, 1e3}) {
    constexpr unsigned seed = 1200;
    Random random(seed);
    const Vec3 centre = offset * test::random_direction(random);
    const Eigen::AngleAxisd turn(1.0, test::random_direction(random));
    SizedFacets facets = cube_surface(6);
    for (SizedFacet& facet : facets) {
      for (Vec3& corner : facet.facet.corners) {
        corner = centre + turn * corner.normalized();
      }
    }
    const FacetTree tree(facets);
    for (int i = 0; i < 30000; ++i) {
      const Vec3 origin = centre + test::random_in_ball(random, 0.9);
      const Facet& facet = facets[test::random_index(random, facets.size())].facet;
      const Vec3& a = facet.corners[0];
      const Vec3& b = facet.corners[1 + i % 2];
      const double s = i % 3 == 0 ? 0.0 : i % 3 == 1 ? 0.5 : test::uniform(random, 0.0, 1.0);
      const Vec3 aim = a + s * (b - a);
      const FacetTree::Closest hit =
          tree.first_hit(origin, (aim - origin).normalized(), FacetTree::infinity,
                         [](std::size_t) { return true; });
      ASSERT_NEAR(hit.distance, (aim - origin).norm(), 1e-9) << query_text(seed, i, origin);
    }
  }
}

TEST(FacetTree, EmptyTreeAnswersEveryQuery) {
  const FacetTree tree(SizedFacets{});
  const auto all = [](std::size_t) { return true; };
  const auto none = [](std::size_t) { return FacetTree::infinity; };
  EXPECT_EQ(tree.first_hit({0, 0, 0}, {0, 0, 1}, 5.0, all).distance, 5.0);
  EXPECT_EQ(tree.closest_facet({0, 0, 0}, 5.0, none).distance, 5.0);
  const auto value = [](std::size_t) { return 1; };
  EXPECT_TRUE(tree.node_values<int>(value, [](int& sum, int other) { sum += other; }).empty());
}

}  // namespace
}  // namespace meshgrow
