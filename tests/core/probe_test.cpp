#include "probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "growth_law.h"
#include "random_facets.h"
#include "size_field.h"
#include "start_sizes/fixed_start_sizes.h"
#include "start_sizes/mesh_start_sizes.h"

namespace meshgrow {
namespace {

const Entity volume = {3, 1};
const Entity other_volume = {3, 2};
const Box everywhere(Vec3(0, 0, 0), Vec3(2, 1, 1));

/// Two volumes of a surface each, with curves.
Topology two_volumes() {
  Topology topology;
  for (const int tag : {1, 2}) {
    const Box box(Vec3(tag - 1, 0, 0), Vec3(tag, 1, 1));
    topology.add_entity({1, tag}, {}, box);
    topology.add_entity({2, tag}, {{1, tag}}, box);
    topology.add_entity({3, tag}, {{2, tag}}, box);
  }
  return topology;
}

FacetedSource random_source(const Entity& entity, test::Random& random, int count) {
  FacetedSource source;
  source.entity = entity;
  for (int i = 0; i < count; ++i) {
    const auto corner = [&, a = test::random_in_box(random, everywhere),
                         length = test::log_uniform(random, 1e-3, 0.1)] {
      return Vec3(a + length * test::random_direction(random));
    };
    if (entity.dim == 1) {
      source.segments.push_back({corner(), corner()});
    } else {
      source.triangles.push_back({corner(), corner(), corner()});
    }
  }
  return source;
}

SizeFunction function_on(Kind kind, std::vector<Entity> sources, std::vector<Entity> attachments,
                         double growth_rate, double size_limit) {
  SizeFunction function;
  function.kind = kind;
  function.sources = std::move(sources);
  function.attachments = std::move(attachments);
  function.growth_rate = growth_rate;
  function.size_limit = size_limit;
  function.start_size = 0.03;
  return function;
}

/// Mesh and fixed functions from curves and surfaces at random, and the same by brute force.
struct RandomField {
  SizeField field;
  /// All facets that a function has from an entity.
  std::map<std::pair<std::size_t, Entity>, SizedFacets> facets;

  RandomField(const FieldOptions& options, unsigned seed) : field(two_volumes(), options) {
    test::Random random(seed);
    add(function_on(Kind::mesh, {{2, 1}, {1, 2}}, {volume}, 1.2, 0.09), random);
    add(function_on(Kind::fixed, {{1, 1}, {2, 2}}, {volume, other_volume}, 1.5, 0.2), random);
    add(function_on(Kind::mesh, {{2, 2}, {1, 1}, {2, 1}}, {other_volume}, 2.0, 0.15), random);
    field.build();
  }

  void add(const SizeFunction& function, test::Random& random) {
    const std::size_t index = field.add(function);
    const double slope = growth_slope(function.growth_rate);
    std::vector<FacetedSource> sources;
    for (const Entity& entity : function.sources) {
      sources.push_back(random_source(entity, random, 25));
      SizedFacets& expected = facets[{index, entity}];
      if (function.kind == Kind::mesh) {
        append_mesh_start_sizes(sources.back(), QuadSize::triangles, slope, expected);
      } else {
        append_fixed_start_sizes(sources.back(), function.start_size, slope, expected);
      }
    }
    field.set_sources(index, sources);
  }
};

FieldOptions options_of(Evaluator evaluator) {
  FieldOptions options;
  options.evaluator = evaluator;
  options.threads = 1;
  return options;
}

TEST(Probe, NamesAFacetAndAFunctionThatAreTheMinimum) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const RandomField random_field(options_of(Evaluator::exact), seed);
    const SizeField& field = random_field.field;
    test::Random random(seed);
    std::set<Rule> rules;
    std::set<std::size_t> functions;
    for (int i = 0; i < 1000; ++i) {
      // Some beyond the reach of float.
      const Vec3 p = i % 100 == 0 ? Vec3(1e18, 0, 0) : test::random_in_box(random, everywhere);
      for (const Entity& entity : {volume, other_volume, Entity{1, 1}}) {
        const std::string where = "seed " + std::to_string(seed) + ", point " + std::to_string(i);
        const Probe probe = field.probe(entity, p);
        ASSERT_EQ(probe.entity, entity);
        ASSERT_EQ(probe.exact_size, field.exact_size(entity, p)) << where;
        ASSERT_EQ(probe.size, field.size(entity, p)) << where;
        ASSERT_TRUE(std::isnan(probe.grid_size));
        const auto acting = field.functions_on(entity);
        ASSERT_EQ(std::count(acting.begin(), acting.end(), probe.function), 1) << where;
        rules.insert(probe.rule);
        functions.insert(probe.function);
        if (probe.rule == Rule::limit) {
          ASSERT_EQ(field.functions()[probe.function].size_limit, probe.exact_size) << where;
          continue;
        }
        ASSERT_EQ(probe.rule, Rule::facet) << where;
        ASSERT_EQ(probe.facet.size_at(p), probe.exact_size) << where;
        ASSERT_EQ(probe.facet.start_size + probe.facet.slope * probe.distance, probe.exact_size);
        ASSERT_TRUE(probe.source.has_value()) << where;
        const auto found = random_field.facets.find({probe.function, *probe.source});
        ASSERT_NE(found, random_field.facets.end()) << where;
        ASSERT_EQ(std::count(found->second.begin(), found->second.end(), probe.facet), 1) << where;
      }
    }
    EXPECT_EQ(rules, (std::set<Rule>{Rule::facet, Rule::limit})) << "seed " << seed;
    EXPECT_EQ(functions.size(), 3u) << "seed " << seed;
  }
}

TEST(Probe, TellsWhatTheGridAnswersBesideTheExactSize) {
  const RandomField random_field(options_of(Evaluator::grid), 7);
  test::Random random(7);
  bool differs = false;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = test::random_in_box(random, everywhere);
    const Probe probe = random_field.field.probe(volume, p);
    ASSERT_EQ(probe.size, random_field.field.size(volume, p));
    ASSERT_EQ(probe.size, probe.grid_size);
    ASSERT_LE(probe.grid_size, 1.05 * probe.exact_size);
    differs = differs || probe.grid_size != probe.exact_size;
  }
  EXPECT_TRUE(differs);
}

TEST(Probe, WithoutAnEntityTheSmallestGroupTells) {
  const RandomField random_field(options_of(Evaluator::exact), 8);
  const SizeField& field = random_field.field;
  test::Random random(8);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = test::random_in_box(random, everywhere);
    const Probe probe = field.probe(p);
    double smallest = SizeField::no_size;
    field.smallest_sizes(&p, 1, &smallest);
    ASSERT_EQ(smallest, std::min(field.size(volume, p), field.size(other_volume, p)));
    ASSERT_EQ(probe.size, smallest);
    ASSERT_EQ(field.size(probe.entity, p), smallest);
  }
}

TEST(Probe, InsideASourceVolumeThereIsOneSize) {
  SizeField field(two_volumes(), options_of(Evaluator::exact));
  field.add(function_on(Kind::mesh, {{2, 2}}, {volume}, 1.2, 0.5));
  field.add(function_on(Kind::fixed, {volume}, {volume}, 1.2, 0.4));
  test::Random random(9);
  field.set_sources(1, {random_source({2, 1}, random, 3)});
  field.build();
  const Probe probe = field.probe(volume, {0.5, 0.5, 0.5});
  EXPECT_EQ(probe.rule, Rule::inside_source);
  EXPECT_EQ(probe.function, 1u);
  EXPECT_EQ(probe.exact_size, 0.03);
  EXPECT_FALSE(probe.source.has_value());
}

TEST(Probe, NothingWhereNoFunctionActs) {
  SizeField field(two_volumes(), options_of(Evaluator::exact));
  EXPECT_EQ(field.probe({0.5, 0.5, 0.5}).rule, Rule::nothing);
  field.add(function_on(Kind::mesh, {{2, 1}}, {volume}, 1.2, 0.5));
  EXPECT_EQ(field.probe(volume, {0.5, 0.5, 0.5}).rule, Rule::nothing) << "before it is built";
  field.build();
  EXPECT_EQ(field.probe(volume, {0.5, 0.5, 0.5}).rule, Rule::nothing) << "without a source";
  EXPECT_EQ(field.probe(other_volume, {0.5, 0.5, 0.5}).rule, Rule::nothing);
  EXPECT_EQ(field.probe(volume, {std::numeric_limits<double>::infinity(), 0, 0}).rule,
            Rule::nothing);
  EXPECT_EQ(field.probe(volume, {0.5, 0.5, 0.5}).size, SizeField::no_size);
}

TEST(Probe, IsAboutWhatWasBuiltLast) {
  RandomField random_field(options_of(Evaluator::exact), 10);
  const Vec3 p = random_field.facets[{0, {2, 1}}][0].facet.centroid();
  const Probe before = random_field.field.probe(volume, p);
  ASSERT_EQ(before.rule, Rule::facet);
  test::Random random(11);
  random_field.field.set_sources(before.function, {random_source({1, 1}, random, 1)});
  const Probe after = random_field.field.probe(volume, p);
  EXPECT_EQ(after.source, before.source);
  EXPECT_EQ(after.exact_size, before.exact_size);
}

TEST(Probe, KnowsTheWallsOfGaps) {
  // A unit cube: each wall is an entity of its own.
  Topology topology;
  std::vector<Entity> faces;
  for (int tag = 1; tag <= 6; ++tag) {
    faces.push_back({2, tag});
    topology.add_entity(faces.back(), {});
  }
  topology.add_entity(volume, faces, test::cube(1.0));
  SizeField field(topology, options_of(Evaluator::exact));
  field.add(function_on(Kind::proximity, {volume}, {volume}, 1.2, 2.0));
  WalledRegion region{{volume, {faces.begin(), faces.end()}}, {}};
  const auto wall_of = [](const Vec3& p) {
    int axis = 0;
    const double most = p.cwiseAbs().maxCoeff(&axis);
    return Entity{2, 1 + 2 * axis + (p[axis] == most ? 1 : 0)};
  };
  for (const Entity& face : faces) {
    const int axis = (face.tag - 1) / 2;
    const double side = face.tag % 2 == 0 ? 1.0 : -1.0;
    const auto at = [&](double u, double v) {
      Vec3 p;
      p[axis] = side;
      p[(axis + 1) % 3] = u;
      p[(axis + 2) % 3] = v;
      return p;
    };
    Vec3 inward = Vec3::Zero();
    inward[axis] = -side;
    constexpr int n = 16;
    const auto node = [&](int i, int j) { return at(-1.0 + 2.0 * i / n, -1.0 + 2.0 * j / n); };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        region.walls.push_back(
            {Facet::triangle(node(i, j), node(i + 1, j), node(i + 1, j + 1)), inward, face});
        region.walls.push_back(
            {Facet::triangle(node(i, j), node(i + 1, j + 1), node(i, j + 1)), inward, face});
      }
    }
  }
  field.set_regions(0, {region});
  field.build();
  test::Random random(12);
  std::set<Entity> named;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = 0.999 * test::random_in_box(random, test::cube(1.0));
    const Probe probe = field.probe(volume, p);
    ASSERT_EQ(probe.rule, Rule::facet) << "seed 12, point " << i;
    ASSERT_EQ(probe.source, wall_of(probe.facet.facet.centroid())) << "seed 12, point " << i;
    named.insert(*probe.source);
  }
  EXPECT_EQ(named.size(), 6u);
}

}  // namespace
}  // namespace meshgrow
