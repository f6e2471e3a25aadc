#include "tree_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "facet_tree.h"
#include "random_facets.h"

namespace meshgrow {
namespace {

TEST(TreeShape, IsThatOfBuiltTrees) {
  constexpr unsigned seed = 8;
  test::Random random(seed);
  for (const std::size_t count :
       {1u, 8u, 9u, 64u, 65u, 72u, 73u, 512u, 513u, 520u, 4097u, 40000u}) {
    SCOPED_TRACE(std::to_string(count) + " facets, seed " + std::to_string(seed));
    test::RandomFacets wanted;
    wanted.count = count;
    const FacetTree tree(test::random_facets(random, wanted));
    const StoredTree& stored = tree.stored();
    const auto blocks = static_cast<std::uint32_t>(stored.blocks.size());
    ASSERT_EQ(stored.nodes.size(), nodes_for(blocks));
    for (std::uint32_t i = 0; i < stored.nodes.size(); ++i) {
      const NodeChildren children = children_of(i, blocks);
      for (int lane = 0; lane < simd::lanes; ++lane) {
        ASSERT_EQ(stored.nodes[i].start_size[lane] < FacetTree::infinity, lane < children.count);
        if (lane < children.count) {
          ASSERT_EQ(stored.nodes[i].child[lane], children.codes[static_cast<std::size_t>(lane)]);
        }
      }
    }
  }
}

/// Every block is reached once, and every node but the first, by ways that are short.
TEST(TreeShape, LargestTreesAreTrees) {
  for (const std::uint32_t blocks : {1u, 7u, 100u, 4096u, 4097u, 300000u}) {
    SCOPED_TRACE(blocks);
    std::vector<int> seen_nodes(nodes_for(blocks), 0);
    std::vector<int> seen_blocks(blocks, 0);
    std::vector<int> depths(seen_nodes.size(), 0);
    for (std::uint32_t node = 0; node < seen_nodes.size(); ++node) {
      const NodeChildren children = children_of(node, blocks);
      for (int i = 0; i < children.count; ++i) {
        const std::uint32_t code = children.codes[static_cast<std::size_t>(i)];
        if ((code & simd::WideNode::is_block) != 0) {
          ++seen_blocks.at(code & ~simd::WideNode::is_block);
        } else {
          ASSERT_GT(code, node);
          ++seen_nodes.at(code);
          depths.at(code) = depths[node] + 1;
        }
      }
    }
    ++seen_nodes[0];
    EXPECT_EQ(seen_nodes, std::vector<int>(seen_nodes.size(), 1));
    EXPECT_EQ(seen_blocks, std::vector<int>(blocks, 1));
    EXPECT_LE(*std::max_element(depths.begin(), depths.end()), 7);
  }
}

}  // namespace
}  // namespace meshgrow
