#include "volume_nesting.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "random_facets.h"

namespace meshgrow {
namespace {

using Volumes = std::set<Entity>;
using Passes = std::vector<std::vector<Entity>>;

Entity volume(int tag) { return {3, tag}; }

Volumes volumes(const std::vector<int>& tags) {
  Volumes result;
  for (const int tag : tags) {
    result.insert(volume(tag));
  }
  return result;
}

/// Volumes by tag, each with the tags of its faces.
Topology model(const std::map<int, std::vector<int>>& faces_of_volumes) {
  Topology topology;
  for (const auto& [tag, faces] : faces_of_volumes) {
    std::vector<Entity> lower;
    for (const int face : faces) {
      topology.add_entity({2, face}, {});
      lower.push_back({2, face});
    }
    topology.add_entity(volume(tag), lower);
  }
  return topology;
}

/// Volume 1 around 2 around 3.
Topology onion() { return model({{1, {1, 10}}, {2, {10, 20}}, {3, {20}}}); }

// ==== Enclosed volumes

TEST(EnclosedVolumes, BallInABox) {
  const Topology topology = model({{1, {1, 2, 3, 10}}, {2, {10}}});
  EXPECT_EQ(enclosed_volumes(volume(1), topology), volumes({2}));
  EXPECT_EQ(enclosed_volumes(volume(2), topology), volumes({}));
}

TEST(EnclosedVolumes, CavityWithoutAVolume) {
  const Topology topology = model({{1, {1, 2, 10}}});
  EXPECT_EQ(enclosed_volumes(volume(1), topology), volumes({}));
}

TEST(EnclosedVolumes, NeighboursDoNotEncloseEachOther) {
  const Topology topology = model({{1, {1, 3}}, {2, {3, 5, 6}}, {3, {6, 7}}});
  for (const int tag : {1, 2, 3}) {
    EXPECT_EQ(enclosed_volumes(volume(tag), topology), volumes({})) << tag;
  }
}

TEST(EnclosedVolumes, VolumesInsideEnclosedOnes) {
  EXPECT_EQ(enclosed_volumes(volume(1), onion()), volumes({2, 3}));
  EXPECT_EQ(enclosed_volumes(volume(2), onion()), volumes({3}));
  EXPECT_EQ(enclosed_volumes(volume(3), onion()), volumes({}));
}

TEST(EnclosedVolumes, SeveralVolumesFillACavityTogether) {
  // 2 and 3 share Surface 12; 4 stands in a cavity of its own.
  const Topology topology = model({{1, {1, 10, 11, 13}}, {2, {10, 12}}, {3, {11, 12}}, {4, {13}}});
  EXPECT_EQ(enclosed_volumes(volume(1), topology), volumes({2, 3, 4}));
  EXPECT_EQ(enclosed_volumes(volume(2), topology), volumes({}));
}

TEST(EnclosedVolumes, VolumeThatReachesTheOutsideIsNotEnclosed) {
  // 3 lies behind 2 and has a face of its own to the outside.
  const Topology topology = model({{1, {1, 10}}, {2, {10, 12}}, {3, {12, 2}}});
  EXPECT_EQ(enclosed_volumes(volume(1), topology), volumes({}));
}

TEST(EnclosedVolumes, EmbeddedEntitiesAreNoFaces) {
  Topology topology = model({{1, {1, 10}}, {2, {10}}});
  topology.add_entity({1, 5}, {});
  topology.add_entity({0, 5}, {});
  topology.add_entity(volume(2), {{2, 10}, {1, 5}, {0, 5}});
  EXPECT_EQ(enclosed_volumes(volume(1), topology), volumes({2}));
}

// ==== Passes

TEST(VolumePasses, VolumesOfOneKindGoTogether) {
  EXPECT_EQ(volume_passes({volume(1), volume(2), volume(3)}, {}, onion()),
            (Passes{{volume(1), volume(2), volume(3)}}));
  EXPECT_EQ(volume_passes({volume(1), volume(2), volume(3)}, volumes({1, 2, 3}), onion()),
            (Passes{{volume(1), volume(2), volume(3)}}));
  EXPECT_EQ(volume_passes({}, {}, onion()), Passes());
}

TEST(VolumePasses, DifferingVolumesInCavitiesComeFirst) {
  const Topology topology = model({{1, {1, 2, 3, 10}}, {2, {10}}});
  const std::vector<Entity> both = {volume(1), volume(2)};
  const Passes inner_first = {{volume(2)}, {volume(1)}};
  EXPECT_EQ(volume_passes(both, volumes({1}), topology), inner_first);
  EXPECT_EQ(volume_passes(both, volumes({2}), topology), inner_first);
}

TEST(VolumePasses, AlternatingShellsComeOneByOne) {
  const Passes innermost_first = {{volume(3)}, {volume(2)}, {volume(1)}};
  const std::vector<Entity> all = {volume(1), volume(2), volume(3)};
  EXPECT_EQ(volume_passes(all, volumes({2}), onion()), innermost_first);
  EXPECT_EQ(volume_passes(all, volumes({1, 3}), onion()), innermost_first);
}

TEST(VolumePasses, OnlyTheVolumesGivenAreMeshed) {
  EXPECT_EQ(volume_passes({volume(3), volume(1)}, volumes({1, 2}), onion()),
            (Passes{{volume(3)}, {volume(1)}}));
}

TEST(VolumePasses, EveryPassIsOfOneKindAndAfterWhatItEncloses) {
  constexpr unsigned seed = 1;
  test::Random random(seed);
  for (int round = 0; round < 300; ++round) {
    // Each volume lies in a cavity of an earlier one, or beside all.
    const auto count = static_cast<int>(1 + test::random_index(random, 12));
    std::map<int, std::vector<int>> faces;
    std::vector<Volumes> around(static_cast<std::size_t>(count) + 1);
    Volumes attached;
    std::vector<Entity> given;
    for (int tag = 1; tag <= count; ++tag) {
      const auto host = static_cast<int>(test::random_index(random, static_cast<std::size_t>(tag)));
      faces[tag].push_back(tag);
      if (host > 0) {
        faces[host].push_back(tag);
        around[static_cast<std::size_t>(tag)] = around[static_cast<std::size_t>(host)];
        around[static_cast<std::size_t>(tag)].insert(volume(host));
      }
      if (test::random_index(random, 2) == 0) {
        attached.insert(volume(tag));
      }
      given.insert(test::random_index(random, 2) == 0 ? given.begin() : given.end(), volume(tag));
    }
    SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
    std::map<Entity, std::size_t> pass_of;
    std::size_t number = 0;
    for (const std::vector<Entity>& pass : volume_passes(given, attached, model(faces))) {
      ASSERT_FALSE(pass.empty());
      for (const Entity& member : pass) {
        EXPECT_TRUE(pass_of.emplace(member, number).second) << "meshed twice";
        EXPECT_EQ(attached.count(member), attached.count(pass.front()));
      }
      ++number;
    }
    EXPECT_EQ(pass_of.size(), given.size());
    for (int tag = 1; tag <= count; ++tag) {
      for (const Entity& outer : around[static_cast<std::size_t>(tag)]) {
        const bool differs = attached.count(outer) != attached.count(volume(tag));
        EXPECT_LT(pass_of[volume(tag)], pass_of[outer] + (differs ? 0 : 1))
            << "Volume " << tag << " in " << entity_name(outer);
      }
    }
  }
}

}  // namespace
}  // namespace meshgrow
