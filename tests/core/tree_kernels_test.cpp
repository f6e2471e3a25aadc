#include "simd/tree_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "brute_force.h"
#include "grid_cell.h"
#include "random_facets.h"
#include "tree_layout.h"

namespace meshgrow {
namespace {

using test::Random;
using test::RandomFacets;

/// Facets in the order of their tree.
struct Tree {
  SizedFacets facets;
  TreeLayout layout;

  explicit Tree(SizedFacets from) : facets(std::move(from)), layout(layout_tree(facets, 1)) {}

  simd::WideTree view() const {
    simd::WideTree view;
    view.nodes = layout.nodes.data();
    view.slopes = layout.slopes.data();
    view.blocks = layout.blocks.data();
    return view;
  }
  Vec3 scaled(const Vec3& p) const { return (p - layout.centre) / layout.unit; }
};

/// A cell and its corners in model units.
struct Cell {
  Vec3 centre;
  double half_edge;
  std::array<double, 8> numbers;  ///< whose reciprocals the kernels take, model units

  Vec3 corner(int i) const {
    return centre + half_edge * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  }

  /// At local coordinates in [0, 1]³.
  Vec3 at(const Vec3& local) const { return corner(0) + 2.0 * half_edge * local; }
  double interpolated(const Vec3& local) const {
    return trilinear(numbers, local.x(), local.y(), local.z());
  }

  simd::CellCorners for_kernel(const Tree& tree) const {
    simd::CellCorners cell;
    const Vec3 place = tree.scaled(centre);
    std::copy(place.data(), place.data() + 3, cell.centre);
    cell.half_edge = static_cast<float>(half_edge / tree.layout.unit);
    for (int i = 0; i < 8; ++i) {
      cell.reciprocals[i] = static_cast<float>(tree.layout.unit / numbers[i]);
    }
    return cell;
  }

  /// Least of tangent plane / number over the corners.
  double ratio(const SizedFacet& facet) const {
    const Vec3 away = centre - closest_point(facet.facet, centre);
    const double distance = away.norm();
    double least = 1e300;
    for (int i = 0; i < 8; ++i) {
      const double change = distance > 0.0 ? away.dot(corner(i) - centre) / distance : 0.0;
      least = std::min(least, (facet.start_size + facet.slope * (distance + change)) / numbers[i]);
    }
    return least;
  }
};

void facets_below(const Tree& tree, std::uint32_t child, std::set<std::uint32_t>& found) {
  if ((child & simd::WideNode::is_block) != 0) {
    const simd::FacetBlock& block = tree.layout.blocks[child & ~simd::WideNode::is_block];
    for (std::uint32_t i = 0; i < block.count; ++i) {
      found.insert(block.first + i);
    }
    return;
  }
  const simd::WideNode& node = tree.layout.nodes[child];
  for (int lane = 0; lane < simd::lanes; ++lane) {
    if (node.start_size[lane] < FLT_MAX) {
      facets_below(tree, node.child[lane], found);
    }
  }
}

/// Of places within a block of these facets, which is as wide as the whole lot at most.
constexpr double rounding = 6e-6;

class TreeKernels : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    kernels_ = simd::tree_kernels(GetParam());
    if (kernels_ == nullptr) {
      GTEST_SKIP() << "this processor has no " << GetParam();
    }
    EXPECT_STREQ(kernels_->name, GetParam());
  }

  /// Of all mixes; `check(tree, random, text)`.
  template <typename Check>
  void for_each_tree(unsigned first_seed, Check check) {
    unsigned seed = first_seed;
    for (const test::FacetMix mix :
         {test::FacetMix::points, test::FacetMix::segments, test::FacetMix::triangles,
          test::FacetMix::mixed, test::FacetMix::degenerate}) {
      Random random(++seed);
      RandomFacets wanted;
      wanted.mix = mix;
      wanted.count = 700;
      wanted.smallest_size = 1e-3;
      wanted.largest_size = 0.1;
      wanted.longest = 0.1;
      const Tree tree(test::random_facets(random, wanted));
      check(tree, random, test::mix_name(mix) + ", seed " + std::to_string(seed));
    }
  }

  static Cell random_cell(const Tree& tree, Random& random) {
    Cell cell;
    cell.centre = test::random_query(random, tree.facets, test::cube(1.0));
    cell.half_edge = test::log_uniform(random, 1e-3, 0.5);
    for (int i = 0; i < 8; ++i) {
      cell.numbers[i] =
          test::brute_force_size(tree.facets, cell.corner(i)) * test::uniform(random, 0.9, 1.1);
    }
    return cell;
  }

  const simd::TreeKernels* kernels_ = nullptr;
};

TEST_P(TreeKernels, LeastSizesLeaveTheRightFacetAmongTheCandidates) {
  for_each_tree(100, [&](const Tree& tree, Random& random, const std::string& text) {
    const simd::NodeEntry root = simd::all_children;
    for (int round = 0; round < 100; ++round) {
      std::vector<simd::LeastSize> queries(1 + round % 11);
      std::vector<Vec3> points;
      for (simd::LeastSize& query : queries) {
        points.push_back(test::random_query(random, tree.facets, test::cube(1.0)));
        const Vec3 place = tree.scaled(points.back());
        std::copy(place.data(), place.data() + 3, query.place);
        query.entries = &root;
        query.entry_count = 1;
        query.limit = FLT_MAX;
        query.overflow = [](simd::LeastSize& full) { full.count = 0; };
      }
      kernels_->least_sizes(tree.view(), queries.data(), static_cast<int>(queries.size()));
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const simd::LeastSize& query = queries[i];
        const double expected = test::brute_force_size(tree.facets, points[i]);
        double best = 1e300;
        for (int k = 0; k < query.count; ++k) {
          const double size = tree.facets[query.facets[k]].size_at(points[i]);
          ASSERT_LE(query.lower_bounds[k] * tree.layout.unit, size * (1.0 + 1e-6)) << text;
          best = std::min(best, size);
        }
        ASSERT_NEAR(best, expected, 1e-12 * expected) << text;
        const double limit = query.limit * tree.layout.unit;
        ASSERT_GE(limit, expected * (1.0 - 1e-7)) << text;
        ASSERT_LE(limit, expected * 1.00001 + rounding) << text;
      }
    }
  });
}

TEST_P(TreeKernels, NothingAboveTheLimitIsACandidate) {
  for_each_tree(200, [&](const Tree& tree, Random& random, const std::string& text) {
    const simd::NodeEntry root = simd::all_children;
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = test::random_query(random, tree.facets, test::cube(1.0));
      simd::LeastSize query;
      const Vec3 place = tree.scaled(p);
      std::copy(place.data(), place.data() + 3, query.place);
      query.entries = &root;
      query.entry_count = 1;
      query.limit =
          static_cast<float>(0.99 * test::brute_force_size(tree.facets, p) / tree.layout.unit);
      query.overflow = [](simd::LeastSize& full) { full.count = 0; };
      kernels_->least_sizes(tree.view(), &query, 1);
      ASSERT_EQ(query.count, 0) << text;
    }
  });
}

TEST_P(TreeKernels, LeastRatioKeepsItsPromiseInTheWholeCell) {
  for_each_tree(300, [&](const Tree& tree, Random& random, const std::string& text) {
    const simd::NodeEntry root = simd::all_children;
    int promised = 0;
    for (int i = 0; i < 1000; ++i) {
      const Cell cell = random_cell(tree, random);
      simd::LeastRatio query{cell.for_kernel(tree), FLT_MAX, -FLT_MAX};
      kernels_->least_ratio(tree.view(), &root, 1, query);
      promised += query.ratio > 0.5 ? 1 : 0;
      for (int k = 0; query.ratio > 0.0 && k < 20; ++k) {
        const Vec3 local = test::random_in_box(random, Box(Vec3::Zero(), Vec3::Ones()));
        const double exact = test::brute_force_size(tree.facets, cell.at(local));
        ASSERT_GE(exact, query.ratio * cell.interpolated(local) * (1.0 - 2e-6))
            << text << ", cell " << i;
      }
      // One ratio suffices to end the search.
      simd::LeastRatio early{cell.for_kernel(tree), FLT_MAX,
                             query.ratio + 0.01f * std::abs(query.ratio) + 0.01f};
      kernels_->least_ratio(tree.view(), &root, 1, early);
      ASSERT_LT(early.ratio, early.enough) << text << ", cell " << i;
    }
    EXPECT_GT(promised, 100) << text;
  });
}

TEST_P(TreeKernels, LeastRatioIsTightAwayFromFacets) {
  for_each_tree(400, [&](const Tree& tree, Random& random, const std::string& text) {
    const simd::NodeEntry root = simd::all_children;
    for (int i = 0; i < 300; ++i) {
      const Cell cell = random_cell(tree, random);
      double expected = 1e300;
      double nearest = 1e300;
      for (const SizedFacet& facet : tree.facets) {
        expected = std::min(expected, cell.ratio(facet));
        nearest = std::min(nearest, distance(facet.facet, cell.centre));
      }
      if (nearest < 0.01) {
        continue;
      }
      simd::LeastRatio query{cell.for_kernel(tree), FLT_MAX, -FLT_MAX};
      kernels_->least_ratio(tree.view(), &root, 1, query);
      ASSERT_GE(query.ratio, expected - 1e-3 * std::max(1.0, std::abs(expected)))
          << text << ", cell " << i;
    }
  });
}

TEST_P(TreeKernels, WhatIsNoSurvivorIsAboveTheNumbersInTheWholeCell) {
  for_each_tree(500, [&](const Tree& tree, Random& random, const std::string& text) {
    const simd::NodeEntry root = simd::all_children;
    std::size_t left_out = 0;
    for (int i = 0; i < 300; ++i) {
      const Cell cell = random_cell(tree, random);
      std::array<simd::NodeEntry, 512> entries;
      simd::Survivors query;
      query.cell = cell.for_kernel(tree);
      query.largest = static_cast<float>(
          *std::max_element(cell.numbers.begin(), cell.numbers.end()) / tree.layout.unit * 1.00001);
      query.open_edge = i % 3 == 0 ? 0.0f : 2.0f * query.cell.half_edge;
      query.open_blocks = i % 2 == 0;
      query.most_facets = ~0u;
      query.entries = entries.data();
      query.capacity = static_cast<int>(entries.size());
      ASSERT_TRUE(kernels_->survivors(tree.view(), &root, 1, query)) << text;
      std::set<std::uint32_t> kept;
      for (int k = 0; k < query.count; ++k) {
        const simd::WideNode& node = tree.layout.nodes[entries[k] >> 8];
        for (int lane = 0; lane < simd::lanes; ++lane) {
          if (entries[k] >> lane & 1) {
            facets_below(tree, node.child[lane], kept);
          }
        }
      }
      left_out += tree.facets.size() - kept.size();
      for (int k = 0; k < 5; ++k) {
        const Vec3 local = test::random_in_box(random, Box(Vec3::Zero(), Vec3::Ones()));
        const double number = cell.interpolated(local) * (1.0 - 1e-5);
        for (std::uint32_t f = 0; f < tree.facets.size(); ++f) {
          if (kept.count(f) == 0) {
            ASSERT_GE(tree.facets[f].size_at(cell.at(local)), number)
                << text << ", cell " << i << ", facet " << f;
          }
        }
      }
      if (query.open_blocks) {
        const std::uint32_t all = query.facets;
        query.most_facets = all == 0 ? 0 : all - 1;
        ASSERT_EQ(kernels_->survivors(tree.view(), &root, 1, query), all == 0) << text;
      }
    }
    EXPECT_GT(left_out, tree.facets.size() * 100) << "hardly anything is left out";
  });
}

TEST_P(TreeKernels, CornerSizesAreUpperBoundsAndHardlyAbove) {
  for_each_tree(600, [&](const Tree& tree, Random& random, const std::string& text) {
    for (int i = 0; i < 2000; ++i) {
      const Cell cell = random_cell(tree, random);
      const std::size_t facet = test::random_index(random, tree.facets.size());
      alignas(32) std::array<float, 8> sizes;
      kernels_->corner_sizes(tree.layout.blocks[facet / simd::lanes],
                             static_cast<int>(facet % simd::lanes), cell.for_kernel(tree),
                             sizes.data());
      for (int k = 0; k < 8; ++k) {
        const double expected = tree.facets[facet].size_at(cell.corner(k));
        ASSERT_GE(sizes[k] * tree.layout.unit, expected * (1.0 - 1e-9)) << text;
        ASSERT_LE(sizes[k] * tree.layout.unit, expected * 1.00001 + rounding) << text;
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Instructions, TreeKernels, testing::Values("plain", "avx2", "avx512"),
                         [](const testing::TestParamInfo<const char*>& param_info) {
                           return std::string(param_info.param);
                         });

TEST(TreeKernelsByName, UnknownNamesGiveNone) {
  EXPECT_EQ(simd::tree_kernels("sse9"), nullptr);
  ASSERT_NE(simd::tree_kernels("plain"), nullptr);
  EXPECT_EQ(simd::tree_kernels(simd::tree_kernels().name), &simd::tree_kernels());
}

}  // namespace
}  // namespace meshgrow
