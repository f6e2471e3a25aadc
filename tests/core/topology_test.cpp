#include "topology.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "error.h"

namespace meshgrow {
namespace {

/// Volume 1 bounded by Surface 1 (with Curve 1, Point 1) and Surface 2 (with Curves 1 and 2). In
/// the volume, Surface 3 is embedded (with Curve 3, Point 3) and Point 4; in Surface 1, Curve 5
/// with Point 5; in Curve 2, Point 6. Volume 2 stands apart.
Topology lens() {
  Topology topology;
  for (int tag = 1; tag <= 6; ++tag) {
    topology.add_entity({0, tag}, {});
  }
  topology.add_entity({1, 1}, {{0, 1}});
  topology.add_entity({1, 2}, {{0, 1}, {0, 2}, {0, 6}});
  topology.add_entity({1, 3}, {{0, 3}});
  topology.add_entity({1, 5}, {{0, 5}});
  topology.add_entity({2, 1}, {{1, 1}, {1, 5}});
  topology.add_entity({2, 2}, {{1, 1}, {1, 2}});
  topology.add_entity({2, 3}, {{1, 3}});
  topology.add_entity({3, 1}, {{2, 1}, {2, 2}, {2, 3}, {0, 4}}, Box(Vec3(0, 0, 0), Vec3(1, 2, 3)));
  topology.add_entity({3, 2}, {});
  return topology;
}

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Topology, ClosureOfAVolumeHoldsBoundariesAndEmbeddedEntities) {
  const std::set<Entity> expected = {{0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}, {0, 6}, {1, 1},
                                     {1, 2}, {1, 3}, {1, 5}, {2, 1}, {2, 2}, {2, 3}, {3, 1}};
  EXPECT_EQ(lens().closure({{3, 1}}), expected);
}

TEST(Topology, ClosureStopsAtWhatIsBelow) {
  const Topology topology = lens();
  EXPECT_EQ(topology.closure({{2, 1}}), (std::set<Entity>{{0, 1}, {0, 5}, {1, 1}, {1, 5}, {2, 1}}));
  EXPECT_EQ(topology.closure({{1, 2}}), (std::set<Entity>{{0, 1}, {0, 2}, {0, 6}, {1, 2}}));
  EXPECT_EQ(topology.closure({{0, 4}}), (std::set<Entity>{{0, 4}}));
  EXPECT_EQ(topology.closure({{3, 2}}), (std::set<Entity>{{3, 2}}));
  EXPECT_TRUE(topology.closure({}).empty());
}

TEST(Topology, ClosureOfSeveralIsTheirUnion) {
  EXPECT_EQ(lens().closure({{1, 3}, {0, 2}, {1, 3}}), (std::set<Entity>{{0, 2}, {0, 3}, {1, 3}}));
}

TEST(Topology, LowerIsOneStepDown) {
  const Topology topology = lens();
  EXPECT_EQ(topology.lower({3, 1}), (std::vector<Entity>{{2, 1}, {2, 2}, {2, 3}, {0, 4}}));
  EXPECT_TRUE(topology.lower({0, 1}).empty());
}

TEST(Topology, EntitiesByDimension) {
  const Topology topology = lens();
  EXPECT_EQ(topology.entities(3), (std::vector<Entity>{{3, 1}, {3, 2}}));
  EXPECT_EQ(topology.entities(1), (std::vector<Entity>{{1, 1}, {1, 2}, {1, 3}, {1, 5}}));
  EXPECT_TRUE(topology.entities(4).empty());
  EXPECT_EQ(topology.entities().size(), 15u);
  EXPECT_TRUE(topology.contains({1, 5}));
  EXPECT_FALSE(topology.contains({1, 4}));
}

TEST(Topology, BoxesAreKept) {
  const Topology topology = lens();
  EXPECT_EQ(topology.box({3, 1}).max(), Vec3(1, 2, 3));
  EXPECT_TRUE(topology.box({3, 2}).isEmpty());
}

TEST(Topology, UnknownEntityIsNamedInTheError) {
  const Topology topology = lens();
  for (const std::string& message : {error_of([&] {
                                       topology.lower({2, 17});
                                     }),
                                     error_of([&] {
                                       topology.box({2, 17});
                                     }),
                                     error_of([&] {
                                       topology.closure({{3, 1}, {2, 17}});
                                     })}) {
    EXPECT_NE(message.find("Surface 17"), std::string::npos) << message;
  }
}

TEST(Topology, BoundaryThatIsNotInTheModelIsNamedInTheError) {
  Topology topology = lens();
  topology.add_entity({2, 9}, {{1, 99}});
  const std::string message = error_of([&] { topology.closure({{2, 9}}); });
  EXPECT_NE(message.find("Curve 99"), std::string::npos) << message;
}

TEST(Topology, PhysicalGroupsAreKeptInOrder) {
  Topology topology;
  topology.add_physical_group({2, 7, "wing", {{2, 1}, {2, 2}}});
  topology.add_physical_group({1, 7, "", {{1, 1}}});
  ASSERT_EQ(topology.physical_groups().size(), 2u);
  EXPECT_EQ(topology.physical_groups()[0].name, "wing");
  EXPECT_EQ(topology.physical_groups()[0].entities, (std::vector<Entity>{{2, 1}, {2, 2}}));
  EXPECT_EQ(topology.physical_groups()[1].dim, 1);
}

}  // namespace
}  // namespace meshgrow
