#include "size_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "brute_force.h"
#include "error.h"
#include "growth_law.h"
#include "random_facets.h"
#include "start_sizes/proximity_start_sizes.h"

namespace meshgrow {
namespace {

using Entities = std::vector<Entity>;
using Indices = std::vector<std::size_t>;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

const Entity left_volume = {3, 1};
const Entity right_volume = {3, 2};
const Entity left_end = {2, 1};
const Entity left_sides = {2, 2};
const Entity middle = {2, 3};
const Entity right_sides = {2, 4};
const Entity right_end = {2, 5};
const Entity left_rim = {1, 1};
const Entity middle_rim = {1, 3};
const Entity right_rim = {1, 5};
const Entity lone_volume = {3, 7};
const Entity lone_surface = {2, 7};

Box slab(double from, double to) { return Box(Vec3(from, 0, 0), Vec3(to, 1, 1)); }

/// Two unit cubes side by side along x that share their face at x = 1, and a cube far away. A cube
/// has two ends, each with a rim of one closed curve with one point, and one surface around.
Topology two_cubes() {
  Topology topology;
  for (const int tag : {1, 3, 5}) {
    const double x = (tag - 1) / 2.0;
    topology.add_entity({0, tag}, {}, Box(Vec3(x, 0, 0), Vec3(x, 0, 0)));
    topology.add_entity({1, tag}, {{0, tag}}, slab(x, x));
    topology.add_entity({2, tag}, {{1, tag}}, slab(x, x));
  }
  topology.add_entity(left_sides, {left_rim, middle_rim}, slab(0, 1));
  topology.add_entity(right_sides, {middle_rim, right_rim}, slab(1, 2));
  topology.add_entity(left_volume, {left_end, left_sides, middle}, slab(0, 1));
  topology.add_entity(right_volume, {middle, right_sides, right_end}, slab(1, 2));
  topology.add_entity({0, 7}, {}, slab(5, 5));
  topology.add_entity({1, 7}, {{0, 7}}, slab(5, 6));
  topology.add_entity(lone_surface, {{1, 7}}, slab(5, 6));
  topology.add_entity(lone_volume, {lone_surface}, slab(5, 6));
  return topology;
}

/// An end of a cube at x, meshed with 2 n² triangles, all of the same size.
FacetedSource end_mesh(const Entity& entity, double x, int n) {
  FacetedSource source;
  source.entity = entity;
  const auto node = [=](int i, int j) {
    return Vec3(x, static_cast<double>(i) / n, static_cast<double>(j) / n);
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      source.triangles.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1)});
      source.triangles.push_back({node(i, j), node(i + 1, j + 1), node(i, j + 1)});
    }
  }
  return source;
}

double end_mesh_size(int n) { return (2.0 + std::sqrt(2.0)) / (3.0 * n); }

FacetedSource point_source(const Entity& entity, const Vec3& p) {
  FacetedSource source;
  source.entity = entity;
  source.points = {p};
  return source;
}

/// The six faces of the left cube.
FacetedSource left_volume_faces() {
  FacetedSource source;
  source.entity = left_volume;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double at : {0.0, 1.0}) {
      std::array<Vec3, 4> quad;
      for (int i = 0; i < 4; ++i) {
        quad[i][axis] = at;
        quad[i][(axis + 1) % 3] = i == 1 || i == 2 ? 1.0 : 0.0;
        quad[i][(axis + 2) % 3] = i >= 2 ? 1.0 : 0.0;
      }
      source.quads.push_back(quad);
    }
  }
  return source;
}

SizeFunction mesh_function(Entities sources, Entities attachments, double growth_rate = 1.25,
                           double size_limit = 2.0) {
  SizeFunction function;
  function.kind = Kind::mesh;
  function.sources = std::move(sources);
  function.attachments = std::move(attachments);
  function.growth_rate = growth_rate;
  function.size_limit = size_limit;
  return function;
}

SizeFunction fixed_function(Entities sources, Entities attachments, double size,
                            double growth_rate = 1.25, double size_limit = 2.0) {
  SizeFunction function =
      mesh_function(std::move(sources), std::move(attachments), growth_rate, size_limit);
  function.kind = Kind::fixed;
  function.start_size = size;
  return function;
}

FieldOptions exact_options() {
  FieldOptions options;
  options.evaluator = Evaluator::exact;
  return options;
}

FieldOptions grid_options() {
  FieldOptions options;
  options.evaluator = Evaluator::grid;
  options.threads = 1;
  return options;
}

/// A field with one function that grows from the left end into the left volume.
SizeField left_field(FieldOptions options, int n = 4) {
  SizeField field(two_cubes(), std::move(options));
  field.add(mesh_function({left_end}, {left_volume}));
  field.set_sources(0, {end_mesh(left_end, 0.0, n)});
  field.build();
  return field;
}

// ==== Where functions act

TEST(SizeField, FunctionActsOnItsAttachmentsAndAllBelow) {
  SizeField field(two_cubes());
  field.add(mesh_function({left_end}, {left_volume}));
  for (const Entity& entity :
       Entities{left_volume, left_end, left_sides, middle, left_rim, middle_rim, {0, 1}, {0, 3}}) {
    EXPECT_TRUE(field.acts_on(entity)) << entity_name(entity);
    EXPECT_EQ(field.functions_on(entity), Indices{0}) << entity_name(entity);
  }
  for (const Entity& entity : Entities{right_volume,
                                       right_sides,
                                       right_end,
                                       right_rim,
                                       {0, 5},
                                       lone_volume,
                                       lone_surface,
                                       {3, 99}}) {
    EXPECT_FALSE(field.acts_on(entity)) << entity_name(entity);
    EXPECT_TRUE(field.functions_on(entity).empty()) << entity_name(entity);
  }
}

TEST(SizeField, EmbeddedEntitiesAreActedOn) {
  Topology topology = two_cubes();
  topology.add_entity({1, 20}, {{0, 1}});
  topology.add_entity({3, 20}, {left_end, {1, 20}});
  SizeField field(topology);
  field.add(mesh_function({left_end}, {{3, 20}}));
  EXPECT_TRUE(field.acts_on({1, 20}));
}

TEST(SizeField, EntitiesWithTheSameFunctionsMakeAGroup) {
  SizeField field(two_cubes());
  EXPECT_TRUE(field.groups().empty());
  field.add(mesh_function({left_end}, {left_volume}));
  ASSERT_EQ(field.groups().size(), 1u);
  EXPECT_EQ(field.groups()[0].entities.size(), 8u);

  field.add(fixed_function({{0, 5}}, {right_volume}, 0.1));
  const std::map<Indices, Entities> expected = {
      {{0}, {{0, 1}, left_rim, left_end, left_sides, left_volume}},
      {{0, 1}, {{0, 3}, middle_rim, middle}},
      {{1}, {{0, 5}, right_rim, right_sides, right_end, right_volume}}};
  std::map<Indices, Entities> groups;
  for (const SizeField::GroupSummary& group : field.groups()) {
    Entities entities = group.entities;
    std::sort(entities.begin(), entities.end());
    EXPECT_TRUE(groups.emplace(group.functions, entities).second) << "a set of functions twice";
  }
  EXPECT_EQ(groups, expected);
  EXPECT_EQ(field.functions_on(middle_rim), (Indices{0, 1}));

  // The same attachments again: no more groups. A lone surface: one more.
  field.add(fixed_function({{0, 1}}, {left_volume, right_volume}, 0.1));
  EXPECT_EQ(field.groups().size(), 3u);
  field.add(fixed_function({{0, 1}}, {lone_surface}, 0.1));
  EXPECT_EQ(field.groups().size(), 4u);
  EXPECT_EQ(field.functions_on(middle), (Indices{0, 1, 2}));
}

TEST(SizeField, FunctionsAreNumberedByKindAndOrder) {
  SizeField field(two_cubes());
  EXPECT_EQ(field.add(mesh_function({left_end}, {left_volume})), 0u);
  EXPECT_EQ(field.add(fixed_function({{0, 5}}, {right_volume}, 0.1)), 1u);
  EXPECT_EQ(field.function_name(0), "Mesh size function 1");
  EXPECT_EQ(field.function_name(1), "Fixed size function 2");
  ASSERT_EQ(field.functions().size(), 2u);
  EXPECT_EQ(field.functions()[1].start_size, 0.1);
}

template <typename Action>
std::string sentence_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

SizeFunction named(SizeFunction function, const std::string& name) {
  function.name = name;
  return function;
}

TEST(SizeField, FunctionsAreFoundByTheirNames) {
  SizeField field(two_cubes());
  field.add(mesh_function({left_end}, {left_volume}));
  field.add(named(fixed_function({{0, 5}}, {right_volume}, 0.1), "rim"));
  field.add(fixed_function({{0, 5}}, {right_volume}, 0.2));
  EXPECT_EQ(field.find("1"), 0u);
  EXPECT_EQ(field.find("rim"), 1u);
  EXPECT_EQ(field.find("3"), 2u);
  EXPECT_EQ(field.function_name(1), "Fixed size function \"rim\"");
  EXPECT_EQ(sentence_of([&] { field.find("2"); }),
            "There is no size function \"2\": give one of \"1\", \"rim\", \"3\".");
  field.rename(0, "inner");
  EXPECT_EQ(field.find("inner"), 0u);
  field.rename(0, "inner");
  EXPECT_NE(sentence_of([&] { field.rename(0, "rim"); }).find("\"rim\" already"),
            std::string::npos);
  EXPECT_NE(sentence_of([&] { field.rename(0, "7"); }).find("not a number"), std::string::npos);
  EXPECT_NE(sentence_of([&] { field.add(named(field.functions()[0], "rim")); }).find("already"),
            std::string::npos);
  EXPECT_EQ(field.functions().size(), 3u);
}

TEST(SizeField, NumbersOfRemovedFunctionsAreNotGivenAgain) {
  SizeField field(two_cubes());
  for (int i = 0; i < 3; ++i) {
    field.add(fixed_function({{0, 1}}, {left_volume}, 0.1));
  }
  field.remove(1);
  field.remove(field.find("3"));
  field.add(fixed_function({{0, 1}}, {left_volume}, 0.1));
  ASSERT_EQ(field.functions().size(), 2u);
  EXPECT_EQ(field.functions()[0].name, "1");
  EXPECT_EQ(field.functions()[1].name, "4");
  EXPECT_EQ(field.function_name(1), "Fixed size function 4");
}

/// Three functions with sources: 0 on the left, 1 on both, 2 on the lone cube.
SizeField three_functions() {
  FieldOptions options;
  options.evaluator = Evaluator::grid;
  SizeField field(two_cubes(), options);
  field.add(mesh_function({left_end}, {left_volume}));
  field.add(mesh_function({right_end}, {left_volume, right_volume}));
  field.add(mesh_function({lone_surface}, {lone_volume}));
  field.set_sources(0, {end_mesh(left_end, 0.0, 8)});
  field.set_sources(1, {end_mesh(right_end, 2.0, 4)});
  field.set_sources(2, {end_mesh(lone_surface, 5.0, 4)});
  field.build();
  return field;
}

std::shared_ptr<const FacetTree> tree_of(const SizeField& field, const Entity& entity) {
  for (const SizeField::Part& part : field.parts().groups) {
    if (std::count(part.entities.begin(), part.entities.end(), entity) > 0) {
      return part.tree;
    }
  }
  return nullptr;
}

TEST(SizeField, RemovingAFunctionLeavesWhatTheOthersAskFor) {
  SizeField field = three_functions();
  const std::shared_ptr<const FacetTree> lone = tree_of(field, lone_volume);
  const std::shared_ptr<const FacetTree> right = tree_of(field, right_volume);
  field.remove(0);
  field.build();
  EXPECT_EQ(tree_of(field, lone_volume), lone) << "built again, though nothing changed there";
  SizeField expected(two_cubes(), field.options());
  expected.add(mesh_function({right_end}, {left_volume, right_volume}));
  expected.add(mesh_function({lone_surface}, {lone_volume}));
  expected.set_sources(0, {end_mesh(right_end, 2.0, 4)});
  expected.set_sources(1, {end_mesh(lone_surface, 5.0, 4)});
  expected.build();
  for (const Entity& entity : {left_volume, right_volume, lone_volume, middle, left_end}) {
    for (const double x : {0.0, 0.3, 1.2, 1.9, 5.5}) {
      EXPECT_EQ(field.size(entity, {x, 0.4, 0.3}), expected.size(entity, {x, 0.4, 0.3}));
    }
    EXPECT_EQ(field.functions_on(entity), expected.functions_on(entity));
  }
  while (!field.functions().empty()) {
    field.remove(0);
  }
  EXPECT_FALSE(field.acts_on(lone_volume));
  EXPECT_EQ(field.size(lone_volume, {5.5, 0.5, 0.5}), infinite);
}

TEST(SizeField, ModifyingAFunctionRebuildsOnlyTheGroupsItActsOn) {
  SizeField field = three_functions();
  const std::shared_ptr<const FacetTree> lone = tree_of(field, lone_volume);
  const std::shared_ptr<const FacetTree> right = tree_of(field, right_volume);
  SizeFunction faster = field.functions()[0];
  faster.growth_rate = 2.0;
  field.modify(0, faster);
  EXPECT_FALSE(field.is_effective(0));
  field.set_sources(0, {end_mesh(left_end, 0.0, 8)});
  field.build();
  EXPECT_EQ(tree_of(field, lone_volume), lone);
  EXPECT_EQ(tree_of(field, right_volume), right);
  const double s0 = (0.125 + 0.125 + 0.125 * std::sqrt(2.0)) / 3.0;
  EXPECT_NEAR(field.exact_size(left_volume, {0.2, 0.5, 0.5}), s0 + 0.5 * 0.2, 1e-12);

  // Attached elsewhere: it leaves the left and comes to the right.
  SizeFunction moved = faster;
  moved.attachments = {lone_volume};
  moved.name = "moved";
  field.modify(0, moved);
  field.set_sources(0, {end_mesh(left_end, 0.0, 8)});
  field.build();
  EXPECT_EQ(field.functions_on(lone_volume), (Indices{0, 2}));
  EXPECT_EQ(field.functions_on(left_volume), (Indices{1}));
  EXPECT_EQ(field.find("moved"), 0u);

  SizeFunction bad = moved;
  bad.growth_rate = 0.5;
  EXPECT_NE(sentence_of([&] { field.modify(0, bad); }).find("\"moved\""), std::string::npos);
  EXPECT_EQ(field.functions()[0].growth_rate, 2.0);
  EXPECT_TRUE(field.is_effective(0));
}

TEST(SizeField, UnusableFunctionIsNamedAndNotAdded) {
  SizeField field(two_cubes());
  field.add(mesh_function({left_end}, {left_volume}));
  try {
    field.add(fixed_function({{0, 5}}, {right_volume}, -0.1));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("Fixed size function 2"), std::string::npos)
        << error.what();
  }
  EXPECT_EQ(field.functions().size(), 1u);
  EXPECT_EQ(field.groups().size(), 1u);
  EXPECT_FALSE(field.acts_on(right_volume));
}

TEST(SizeField, NothingIsAddedWhenABoundaryIsNotInTheModel) {
  Topology topology = two_cubes();
  topology.add_entity({3, 30}, {{2, 99}});
  SizeField field(topology);
  field.add(mesh_function({left_end}, {left_volume}));
  EXPECT_THROW(field.add(mesh_function({left_end}, {{3, 30}})), Error);
  EXPECT_EQ(field.functions().size(), 1u);
  // And what comes next is not hindered by it.
  EXPECT_NO_THROW(field.add(mesh_function({right_end}, {right_volume})));
}

// ==== Sizes

TEST(SizeField, MeshSizesGrowFromTheSource) {
  const double start = end_mesh_size(4);
  for (const FieldOptions& options : {exact_options(), grid_options()}) {
    const SizeField field = left_field(options);
    for (const double x : {0.0, 0.1, 0.5, 0.9, 1.0}) {
      const Vec3 p(x, 0.4, 0.7);
      const double expected = start + 0.2 * x;
      EXPECT_NEAR(field.exact_size(left_volume, p), expected, 1e-12);
      EXPECT_NEAR(field.size(left_volume, p), expected, 0.05 * expected);
      EXPECT_EQ(field.size(left_volume, p), field.size(left_sides, p));
    }
    EXPECT_NEAR(field.exact_size(left_rim, {0, 0, 0.5}), start, 1e-12);
    EXPECT_NEAR(field.exact_size({0, 3}, {1, 0, 0}), start + 0.2, 1e-12);
  }
}

TEST(SizeField, SizeLimitIsKept) {
  SizeField field(two_cubes(), exact_options());
  field.add(mesh_function({left_end}, {left_volume}, 1.25, 0.35));
  field.set_sources(0, {end_mesh(left_end, 0.0, 4)});
  field.build();
  EXPECT_NEAR(field.size(left_volume, {0.1, 0.5, 0.5}), end_mesh_size(4) + 0.02, 1e-12);
  EXPECT_EQ(field.size(left_volume, {0.9, 0.5, 0.5}), 0.35);
  EXPECT_EQ(field.groups()[0].size_limit, 0.35);
}

TEST(SizeField, QuadsAreSizedByTheFunctionsRule) {
  FacetedSource source;
  source.entity = left_end;
  source.quads = {{Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(0, 1, 1), Vec3(0, 0, 1)}};
  for (const QuadSize rule : {QuadSize::triangles, QuadSize::sides}) {
    SizeFunction function = mesh_function({left_end}, {left_volume});
    function.quad_size = rule;
    SizeField field(two_cubes(), exact_options());
    field.add(function);
    field.set_sources(0, {source});
    field.build();
    const double expected = rule == QuadSize::sides ? 1.0 : end_mesh_size(1);
    EXPECT_NEAR(field.size(left_volume, {0, 0.5, 0.5}), expected, 1e-12);
  }
}

TEST(SizeField, FixedSizesGrowFromTheSource) {
  SizeField field(two_cubes(), exact_options());
  field.add(fixed_function({{0, 5}}, {right_volume}, 0.05, 1.5));
  field.set_sources(0, {point_source({0, 5}, {2, 0, 0})});
  field.build();
  EXPECT_NEAR(field.size({0, 5}, {2, 0, 0}), 0.05, 1e-15);
  EXPECT_NEAR(field.size(right_volume, {1, 0, 0}), 0.05 + 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(field.size(right_sides, {1.4, 0.8, 0}), 0.05 + 1.0 / 3.0, 1e-12);
}

TEST(SizeField, SmallestOfSeveralFunctionsWithTheirOwnGrowthAndLimit) {
  // On the middle three functions meet; elsewhere two or one.
  SizeField field(two_cubes(), exact_options());
  field.add(mesh_function({left_end}, {left_volume}, 1.25, 0.45));
  field.add(fixed_function({{0, 5}}, {right_volume}, 0.01, 2.0, 0.5));
  field.add(fixed_function({{0, 1}}, {left_volume, right_volume}, 0.1, 1.1, 0.7));
  const std::vector<std::vector<FacetedSource>> sources = {{end_mesh(left_end, 0.0, 16)},
                                                           {point_source({0, 5}, {2, 0, 0})},
                                                           {point_source({0, 1}, {0, 0, 0})}};
  for (std::size_t i = 0; i < 3; ++i) {
    field.set_sources(i, sources[i]);
  }
  field.build();

  constexpr unsigned seed = 1;
  test::Random random(seed);
  int ruling[3] = {0, 0, 0};
  for (int i = 0; i < 3000; ++i) {
    const Vec3 p = test::random_in_box(random, slab(0, 2));
    // The end's facets fill the unit square at x = 0.
    const double sizes[3] = {std::min(0.45, end_mesh_size(16) + 0.2 * p.x()),
                             std::min(0.5, 0.01 + 0.5 * (p - Vec3(2, 0, 0)).norm()),
                             std::min(0.7, 0.1 + (1.0 - 1.0 / 1.1) * p.norm())};
    const double on_left = std::min(sizes[0], sizes[2]);
    const double on_right = std::min(sizes[1], sizes[2]);
    const double on_middle = std::min(on_left, on_right);
    ASSERT_NEAR(field.size(left_volume, p), on_left, 1e-12) << "seed " << seed;
    ASSERT_NEAR(field.size(right_volume, p), on_right, 1e-12) << "seed " << seed;
    ASSERT_NEAR(field.size(middle, p), on_middle, 1e-12) << "seed " << seed;
    ++ruling[std::min_element(sizes, sizes + 3) - sizes];
  }
  EXPECT_GT(*std::min_element(ruling, ruling + 3), 50) << "a function never rules";
}

TEST(SizeField, SeveralSourcesOfOneFunction) {
  SizeField field(two_cubes(), exact_options());
  field.add(mesh_function({left_end, right_end}, {left_volume, right_volume}));
  field.set_sources(0, {end_mesh(left_end, 0.0, 4), end_mesh(right_end, 2.0, 8)});
  field.build();
  EXPECT_EQ(field.groups()[0].facets, 2u * 16u + 2u * 64u);
  EXPECT_NEAR(field.size(left_volume, {0, 0.5, 0.5}), end_mesh_size(4), 1e-12);
  EXPECT_NEAR(field.size(right_volume, {2, 0.5, 0.5}), end_mesh_size(8), 1e-12);
}

TEST(SizeField, DroppedElementsOfAllSourcesAreCounted) {
  FacetedSource bad = end_mesh(left_end, 0.0, 1);
  bad.triangles.push_back({Vec3(0, 1, 1), Vec3(0, 1, 1), Vec3(0, 1, 1)});
  bad.segments.push_back({Vec3(0, 1, 1), Vec3(not_a_number, 1, 1)});
  SizeField field(two_cubes(), exact_options());
  field.add(mesh_function({left_end}, {left_volume}));
  const DroppedFacets dropped = field.set_sources(0, {bad, bad, end_mesh(left_end, 0.0, 1)});
  EXPECT_EQ(dropped.zero_size, 2u);
  EXPECT_EQ(dropped.not_finite, 2u);
  field.build();
  EXPECT_EQ(field.groups()[0].facets, 6u);
}

// ==== Where no size is asked for

TEST(SizeField, NoSizeOnEntitiesWithoutAFunction) {
  for (const FieldOptions& options : {exact_options(), grid_options()}) {
    const SizeField field = left_field(options);
    const Vec3 p(0.5, 0.5, 0.5);
    for (const Entity& entity :
         Entities{right_volume, right_end, lone_volume, {0, 7}, {3, 99}, {-1, 5}}) {
      EXPECT_EQ(field.size(entity, p), SizeField::no_size) << entity_name(entity);
      EXPECT_EQ(field.exact_size(entity, p), SizeField::no_size) << entity_name(entity);
    }
    EXPECT_LT(field.size(left_volume, p), 1.0);
  }
}

TEST(SizeField, NoSizeAtPointsThatAreNotFinite) {
  for (const FieldOptions& options : {exact_options(), grid_options()}) {
    const SizeField field = left_field(options);
    for (const double bad : {not_a_number, infinite, -infinite}) {
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 p(0.5, 0.5, 0.5);
        p[axis] = bad;
        EXPECT_EQ(field.size(left_volume, p), SizeField::no_size);
        EXPECT_EQ(field.exact_size(left_volume, p), SizeField::no_size);
      }
    }
  }
}

TEST(SizeField, NoSizeBeforeTheFirstBuild) {
  SizeField field(two_cubes(), exact_options());
  field.add(mesh_function({left_end}, {left_volume}));
  EXPECT_EQ(field.size(left_volume, {0.5, 0.5, 0.5}), SizeField::no_size);
  field.set_sources(0, {end_mesh(left_end, 0.0, 4)});
  EXPECT_EQ(field.size(left_volume, {0.5, 0.5, 0.5}), SizeField::no_size);
  EXPECT_EQ(field.exact_size(left_volume, {0.5, 0.5, 0.5}), SizeField::no_size);
}

TEST(SizeField, FunctionWithoutSourcesHasNoEffectNorHasItsLimit) {
  for (const FieldOptions& options : {exact_options(), grid_options()}) {
    SizeField field(two_cubes(), options);
    field.add(mesh_function({left_end}, {left_volume}));
    field.add(mesh_function({right_end}, {right_volume}, 1.25, 1e-3));
    field.set_sources(0, {end_mesh(left_end, 0.0, 4)});
    EXPECT_TRUE(field.is_effective(0));
    EXPECT_FALSE(field.is_effective(1));
    field.build();
    const Vec3 p(1, 0.5, 0.5);
    EXPECT_NEAR(field.exact_size(middle, p), end_mesh_size(4) + 0.2, 1e-12);
    EXPECT_NEAR(field.size(middle, p), end_mesh_size(4) + 0.2, 0.05 * 0.5);
    EXPECT_EQ(field.size(right_volume, p), SizeField::no_size);
    EXPECT_EQ(field.exact_size(right_volume, p), SizeField::no_size);

    // An empty source is as good as none.
    field.set_sources(1, {FacetedSource()});
    field.build();
    EXPECT_FALSE(field.is_effective(1));
    EXPECT_EQ(field.size(right_volume, p), SizeField::no_size);

    field.set_sources(1, {end_mesh(right_end, 2.0, 4)});
    EXPECT_TRUE(field.is_effective(1));
    field.build();
    EXPECT_NEAR(field.size(middle, p), 1e-3, 1e-9);
    EXPECT_NEAR(field.size(right_volume, p), 1e-3, 1e-9);
    EXPECT_NEAR(field.exact_size(left_volume, p), end_mesh_size(4) + 0.2, 1e-12);
  }
}

// ==== Volumes as sources

TEST(SizeField, FixedSourceVolumeHasItsSizeInsideAndGrowsOutside) {
  for (const FieldOptions& options : {exact_options(), grid_options()}) {
    SizeField field(two_cubes(), options);
    field.add(fixed_function({left_volume}, {left_volume, right_volume}, 0.1, 1.25, 0.25));
    field.set_sources(0, {left_volume_faces()});
    field.build();
    EXPECT_EQ(field.groups().size(), 2u);
    constexpr unsigned seed = 2;
    test::Random random(seed);
    for (int i = 0; i < 500; ++i) {
      const Vec3 inside = test::random_in_box(random, slab(0, 1));
      // The middle belongs to both volumes, but bounds the source.
      for (const Entity& entity : {left_volume, left_sides, left_end, middle, middle_rim}) {
        ASSERT_NEAR(field.size(entity, inside), 0.1, 1e-8) << entity_name(entity);
        ASSERT_EQ(field.exact_size(entity, inside), 0.1) << entity_name(entity);
      }
      const Vec3 outside = test::random_in_box(random, slab(1, 2));
      const double expected = std::min(0.25, 0.1 + 0.2 * (outside.x() - 1.0));
      for (const Entity& entity : {right_volume, right_sides, right_rim}) {
        ASSERT_NEAR(field.exact_size(entity, outside), expected, 1e-12) << "seed " << seed;
        ASSERT_LE(field.size(entity, outside), 1.05 * expected) << "seed " << seed;
        ASSERT_GE(field.size(entity, outside), expected / 1.1) << "seed " << seed;
      }
    }
  }
}

TEST(SizeField, SizeInsideASourceVolumeKeepsTheLimitAndOtherFunctions) {
  SizeField field(two_cubes(), exact_options());
  field.add(fixed_function({left_volume}, {left_volume}, 0.1, 1.25, 0.06));
  field.add(fixed_function({{0, 1}}, {left_volume}, 0.01, 1.25));
  field.set_sources(0, {left_volume_faces()});
  field.set_sources(1, {point_source({0, 1}, {0, 0, 0})});
  field.build();
  EXPECT_NEAR(field.size(left_volume, {0, 0, 0.1}), 0.03, 1e-12);
  EXPECT_NEAR(field.size(left_volume, {0.5, 0.5, 0.5}), 0.06, 1e-12);
}

TEST(SizeField, SourceVolumeWithoutPiecesHasNoEffect) {
  SizeField field(two_cubes(), exact_options());
  field.add(fixed_function({left_volume}, {left_volume, right_volume}, 0.1));
  field.build();
  EXPECT_EQ(field.size(left_volume, {0.5, 0.5, 0.5}), SizeField::no_size);
}

// ==== Four kinds together

/// A size function of another kind.
SizeFunction function_of(Kind kind, Entities sources, Entities attachments, double growth_rate,
                         double size_limit) {
  SizeFunction function =
      mesh_function(std::move(sources), std::move(attachments), growth_rate, size_limit);
  function.kind = kind;
  return function;
}

/// The left and right end of the left cube, as walls that look at each other.
WalledRegion left_cube_walls() {
  WalledRegion region{{left_volume, {left_end, middle}}, {}};
  for (const auto& [entity, x] : {std::make_pair(left_end, 0.0), std::make_pair(middle, 1.0)}) {
    for (const auto& [a, b, c] : end_mesh(entity, x, 1).triangles) {
      region.walls.push_back({Facet::triangle(a, b, c), Vec3(x == 0.0 ? 1 : -1, 0, 0), entity});
    }
  }
  return region;
}

/// All four kinds on the left cube, each with its own growth and limit; the sizes of each alone are
/// those of `alone`.
SizeField four_kinds(const FieldOptions& options, const Indices& alone = {0, 1, 2, 3}) {
  std::vector<SizeFunction> functions = {
      mesh_function({left_end}, {left_volume}, 2.5, 0.5),
      fixed_function({left_rim}, {left_volume}, 0.05, 1.5, 0.6),
      function_of(Kind::curvature, {middle}, {left_volume}, 1.1, 0.45),
      function_of(Kind::proximity, {left_volume}, {left_volume}, 1.3, 0.7)};
  functions[3].cells_per_gap = 6.0;
  FacetedSource bent = end_mesh(middle, 1.0, 1);
  bent.triangle_curvatures = {0.8, 4.0};
  SizeField field(two_cubes(), options);
  for (const std::size_t i : alone) {
    const std::size_t index = field.add(functions[i]);
    switch (functions[i].kind) {
      case Kind::mesh:
        field.set_sources(index, {end_mesh(left_end, 0.0, 16)});
        break;
      case Kind::fixed:
        field.set_sources(index, {point_source(left_rim, {0.5, 1.0, 0.2})});
        break;
      case Kind::curvature:
        field.set_sources(index, {bent});
        break;
      case Kind::proximity:
        field.set_regions(index, {left_cube_walls()});
        break;
    }
  }
  field.build();
  return field;
}

TEST(SizeField, SmallestOfFourKindsWithTheirOwnGrowthAndLimit) {
  const SizeField together = four_kinds(exact_options());
  const SizeField on_grid = four_kinds(grid_options());
  std::vector<SizeField> alone;
  for (const std::size_t i : {0, 1, 2, 3}) {
    alone.push_back(four_kinds(exact_options(), {i}));
  }
  constexpr unsigned seed = 12;
  test::Random random(seed);
  std::set<std::size_t> ruling;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = test::random_in_box(random, slab(-0.1, 1.1));
    std::vector<double> sizes;
    for (const SizeField& field : alone) {
      sizes.push_back(field.size(left_volume, p));
    }
    const auto smallest = std::min_element(sizes.begin(), sizes.end());
    ruling.insert(static_cast<std::size_t>(smallest - sizes.begin()));
    ASSERT_EQ(together.size(left_volume, p), *smallest) << p.transpose() << ", seed " << seed;
    ASSERT_LE(on_grid.size(left_volume, p), 1.05 * *smallest) << p.transpose();
  }
  EXPECT_EQ(ruling.size(), 4u) << "each kind should rule somewhere";
}

TEST(SizeField, AllKindsOnTheSameEntitiesShareOneGrid) {
  const SizeField field = four_kinds(grid_options());
  ASSERT_EQ(field.groups().size(), 1u);
  EXPECT_TRUE(field.groups()[0].has_grid);
  EXPECT_EQ(field.groups()[0].functions, (Indices{0, 1, 2, 3}));
  EXPECT_EQ(field.groups()[0].size_limit, 0.45);
}

TEST(SizeField, NumberOfGridsIsThatOfDifferentSetsOfFunctions) {
  SizeField field(two_cubes(), grid_options());
  const auto curvature = [&](Entities attachments) {
    FacetedSource bent = end_mesh(middle, 1.0, 1);
    bent.triangle_curvatures = {3.0, 3.0};
    const std::size_t index =
        field.add(function_of(Kind::curvature, {middle}, std::move(attachments), 1.2, 1.0));
    field.set_sources(index, {bent});
  };
  const auto grids = [&] {
    field.build();
    const auto groups = field.groups();
    return std::count_if(groups.begin(), groups.end(), [](const auto& g) { return g.has_grid; });
  };
  curvature({left_volume, right_volume});
  EXPECT_EQ(grids(), 1);
  curvature({left_volume});
  EXPECT_EQ(grids(), 2) << "left, and what is only right";
  curvature({right_volume});
  EXPECT_EQ(grids(), 3) << "left, common, right";
  curvature({left_volume, right_volume});
  EXPECT_EQ(grids(), 3);
  curvature({lone_volume});
  EXPECT_EQ(grids(), 4);
}

TEST(SizeField, FlatSourceOfCurvatureStillHasItsLimit) {
  for (const FieldOptions& options : {exact_options(), grid_options()}) {
    SizeField field(two_cubes(), options);
    field.add(function_of(Kind::curvature, {left_end}, {left_volume}, 1.2, 0.75));
    field.add(mesh_function({right_end}, {right_volume}));
    EXPECT_FALSE(field.is_effective(0)) << "before it knows its sources";
    FacetedSource flat = end_mesh(left_end, 0.0, 4);
    flat.triangle_curvatures.assign(flat.triangles.size(), 0.0);
    field.set_sources(0, {flat});
    EXPECT_TRUE(field.is_effective(0));
    field.build();
    EXPECT_EQ(field.size(left_volume, {0.5, 0.5, 0.5}), 0.75);
    EXPECT_EQ(field.exact_size(left_rim, {0, 0, 0}), 0.75);
    EXPECT_EQ(field.size(right_volume, {1.5, 0.5, 0.5}), SizeField::no_size);
  }
}

TEST(SizeField, GapsGrowFromBothWallsAndOnlyFromSources) {
  SizeFunction function = function_of(Kind::proximity, {left_volume}, {left_volume}, 1.25, 0.75);
  function.cells_per_gap = 4.0;
  SizeField field(two_cubes(), exact_options());
  field.add(function);
  field.set_regions(0, {left_cube_walls()});
  field.build();
  const double start = gap_start_size(1.0, 4.0, 1.25);
  EXPECT_NEAR(field.size(left_volume, {0.0, 0.5, 0.5}), start, 1e-9);
  EXPECT_NEAR(field.size(left_volume, {1.0, 0.3, 0.7}), start, 1e-9);
  EXPECT_NEAR(field.size(left_volume, {0.5, 0.5, 0.5}), start + 0.1, 1e-9);

  WalledRegion one_source = left_cube_walls();
  one_source.gaps.sources = {left_end};
  field.set_regions(0, {one_source});
  field.build();
  EXPECT_NEAR(field.size(left_volume, {0.0, 0.5, 0.5}), start, 1e-9);
  EXPECT_NEAR(field.size(left_volume, {1.0, 0.5, 0.5}), start + 0.2, 1e-9);

  field.set_regions(0, {});
  field.build();
  EXPECT_EQ(field.size(left_volume, {0.0, 0.5, 0.5}), 0.75);
}

// ==== Grid and exact sizes

/// Random facets as sources in both cubes.
SizeField random_field(const FieldOptions& options, unsigned seed) {
  test::Random random(seed);
  SizeField field(two_cubes(), options);
  field.add(mesh_function({left_end}, {left_volume}, 1.2, 0.3));
  field.add(mesh_function({right_end}, {left_volume, right_volume}, 1.4, 0.5));
  for (std::size_t function = 0; function < 2; ++function) {
    FacetedSource source;
    for (int i = 0; i < 300; ++i) {
      const Vec3 a = test::random_in_box(random, slab(0, 2));
      const double length = test::log_uniform(random, 1e-3, 0.1);
      source.triangles.push_back({a, a + length * test::random_direction(random),
                                  a + length * test::random_direction(random)});
      source.segments.push_back({a, a + length * test::random_direction(random)});
    }
    field.set_sources(function, {source});
  }
  field.build();
  return field;
}

TEST(SizeField, GridIsWithinItsToleranceOfExactSizes) {
  constexpr unsigned seed = 3;
  for (const double tolerance : {0.02, 0.1}) {
    FieldOptions options = grid_options();
    options.tolerance = tolerance;
    const SizeField grid = random_field(options, seed);
    const SizeField exact = random_field(exact_options(), seed);
    test::Random random(seed);
    std::vector<double> under;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 p = test::random_in_box(random, slab(-0.2, 2.2));
      for (const Entity& entity : {left_volume, right_volume}) {
        const double expected = exact.size(entity, p);
        ASSERT_EQ(exact.exact_size(entity, p), expected);
        ASSERT_EQ(grid.exact_size(entity, p), expected);
        const double size = grid.size(entity, p);
        ASSERT_LE(size, (1.0 + tolerance) * expected) << p.transpose() << ", seed " << seed;
        under.push_back(expected / size - 1.0);
      }
    }
    std::sort(under.begin(), under.end());
    EXPECT_LE(under[under.size() * 999 / 1000], 2.0 * tolerance) << "seed " << seed;
  }
}

TEST(SizeField, EvaluatorDecidesWhoAnswers) {
  const SizeField grid = left_field(grid_options(), 20);
  ASSERT_EQ(grid.groups().size(), 1u);
  EXPECT_TRUE(grid.groups()[0].has_grid);
  EXPECT_GT(grid.groups()[0].grid.interpolated_leaves, 0u);
  EXPECT_GT(grid.groups()[0].tree_bytes, 0u);
  EXPECT_EQ(grid.groups()[0].facets, 800u);
  const SizeField exact = left_field(exact_options(), 20);
  EXPECT_FALSE(exact.groups()[0].has_grid);
  EXPECT_EQ(exact.groups()[0].facets, 800u);
}

TEST(SizeField, AutomaticEvaluatorBuildsAGridWhereItPays) {
  FieldOptions options = grid_options();
  options.evaluator = Evaluator::automatic;
  SizeField field = left_field(options, 20);
  const auto has_grid = [&field] { return field.groups()[0].has_grid; };
  EXPECT_FALSE(has_grid()) << "nobody is about to mesh";
  field.build({left_volume}, 0.2);
  EXPECT_FALSE(has_grid()) << "few sizes are asked for";
  field.build({left_end}, 1e9);
  EXPECT_FALSE(has_grid()) << "surfaces ask for few sizes";
  field.build({left_volume}, 1e9);
  EXPECT_TRUE(has_grid());
  // What there is, is kept.
  field.build({left_volume}, 0.0);
  EXPECT_TRUE(has_grid());
}

TEST(SizeField, CountsItsAnswers) {
  const SizeField field = left_field(grid_options(), 20);
  const Box inside(Vec3(0, 0, 0), Vec3(1, 1, 1));
  test::Random random(12);
  std::vector<Vec3> points;
  for (int i = 0; i < 1000; ++i) {
    points.push_back(test::random_in_box(random, inside));
  }
  std::vector<double> sizes(points.size());
  field.sizes(left_volume, points.data(), points.size(), sizes.data());
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(sizes[i], field.size(left_volume, points[i])) << "seed 12";
  }
  field.exact_size(left_volume, points[0]);  // does not count
  const SizeField::GroupSummary group = field.groups()[0];
  EXPECT_EQ(group.answers, 2000u);
  EXPECT_GT(group.exact_answers, 0u);
  EXPECT_LT(group.exact_answers, 2000u);
}

TEST(SizeField, ManyPointsAtOnceGetWhatEachGets) {
  // Also where a point is not finite, or no function acts.
  for (const Evaluator evaluator : {Evaluator::grid, Evaluator::exact}) {
    FieldOptions options = grid_options();
    options.evaluator = evaluator;
    const SizeField field = left_field(options, 20);
    test::Random random(13);
    std::vector<Vec3> points;
    for (int i = 0; i < 300; ++i) {
      points.push_back(test::random_in_box(random, test::cube(2.0)));
      if (i % 37 == 0) {
        points.push_back(Vec3(0.5, std::nan(""), 0.5));
        points.push_back(Vec3(1e300, 0.5, 0.5));
      }
    }
    for (const Entity& entity : {left_volume, right_volume}) {
      std::vector<double> sizes(points.size());
      std::vector<double> exact(points.size());
      field.sizes(entity, points.data(), points.size(), sizes.data());
      field.exact_sizes(entity, points.data(), points.size(), exact.data());
      for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_EQ(sizes[i], field.size(entity, points[i])) << "seed 13, point " << i;
        ASSERT_EQ(exact[i], field.exact_size(entity, points[i])) << "seed 13, point " << i;
      }
    }
  }
}

TEST(SizeField, FinerToleranceMakesMoreCells) {
  FieldOptions options = grid_options();
  options.tolerance = 0.02;
  const SizeField fine = left_field(options, 20);
  options.tolerance = 0.2;
  const SizeField coarse = left_field(options, 20);
  EXPECT_GT(fine.groups()[0].grid.blocks, coarse.groups()[0].grid.blocks);
}

TEST(SizeField, SizesOutsideTheBoxOfTheGroupAreExact) {
  const SizeField field = left_field(grid_options(), 10);
  constexpr unsigned seed = 4;
  test::Random random(seed);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = Vec3(0.5, 0.5, 0.5) +
                   test::log_uniform(random, 1.0, 100.0) * test::random_direction(random);
    ASSERT_EQ(field.size(left_volume, p), field.exact_size(left_volume, p)) << "seed " << seed;
  }
  EXPECT_EQ(field.size(left_volume, {1e300, 0, 0}), 2.0);
}

TEST(SizeField, EntitiesWithoutABoxGetExactSizes) {
  Topology topology;
  topology.add_entity({1, 1}, {});
  topology.add_entity({2, 1}, {{1, 1}});
  SizeField field(topology, grid_options());
  field.add(mesh_function({{1, 1}}, {{2, 1}}));
  FacetedSource source;
  source.segments = {{Vec3(0, 0, 0), Vec3(0.5, 0, 0)}};
  field.set_sources(0, {source});
  field.build();
  EXPECT_NEAR(field.size({2, 1}, {0, 1, 0}), 0.7, 1e-12);
  EXPECT_NEAR(field.size({2, 1}, {0, 0, 0}), 0.5, 1e-12);
}

// ==== Changes

TEST(SizeField, NewSourcesTakeEffectWithTheNextBuild) {
  for (const FieldOptions& options : {exact_options(), grid_options()}) {
    SizeField field = left_field(options, 4);
    const Vec3 p(0, 0.5, 0.5);
    EXPECT_NEAR(field.size(left_volume, p), end_mesh_size(4), 0.02);
    field.set_sources(0, {end_mesh(left_end, 0.0, 8)});
    EXPECT_NEAR(field.size(left_volume, p), end_mesh_size(4), 0.02) << "before it is built";
    field.build();
    EXPECT_NEAR(field.size(left_volume, p), end_mesh_size(8), 0.01);
    EXPECT_NEAR(field.exact_size(left_volume, p), end_mesh_size(8), 1e-12);
    field.set_sources(0, {});
    field.build();
    EXPECT_EQ(field.size(left_volume, p), SizeField::no_size);
  }
}

TEST(SizeField, BuildsOnlyTheGroupsOfTheEntitiesNamed) {
  SizeField field(two_cubes(), exact_options());
  field.add(mesh_function({left_end}, {left_volume}));
  field.add(mesh_function({right_end}, {right_volume}));
  field.set_sources(0, {end_mesh(left_end, 0.0, 4)});
  field.set_sources(1, {end_mesh(right_end, 2.0, 4)});
  const Vec3 p(1, 0.5, 0.5);
  field.build({left_sides, lone_volume});
  EXPECT_NEAR(field.size(left_volume, p), end_mesh_size(4) + 0.2, 1e-12);
  EXPECT_EQ(field.size(right_volume, p), SizeField::no_size);
  EXPECT_EQ(field.size(middle, p), SizeField::no_size);
  field.build({middle_rim});
  EXPECT_NEAR(field.size(middle, p), end_mesh_size(4) + 0.2, 1e-12);
  EXPECT_EQ(field.size(right_volume, p), SizeField::no_size);
  field.build();
  EXPECT_NEAR(field.size(right_volume, p), end_mesh_size(4) + 0.2, 1e-12);
}

TEST(SizeField, GroupsNotBuiltSinceNewSourcesAnswerAsBefore) {
  SizeField field(two_cubes(), exact_options());
  field.add(mesh_function({left_end}, {left_volume}));
  field.add(mesh_function({right_end}, {right_volume}));
  field.set_sources(0, {end_mesh(left_end, 0.0, 4)});
  field.set_sources(1, {end_mesh(right_end, 2.0, 4)});
  field.build();
  field.set_sources(0, {end_mesh(left_end, 0.0, 8)});
  field.build({left_volume});
  EXPECT_NEAR(field.size(left_volume, {1, 0.5, 0.5}), end_mesh_size(8) + 0.2, 1e-12);
  EXPECT_NEAR(field.size(middle, {1, 0.5, 0.5}), end_mesh_size(4) + 0.2, 1e-12);
}

TEST(SizeField, GroupsNotBuiltSinceAFunctionWasAddedAnswerAsBefore) {
  SizeField field = left_field(exact_options(), 4);
  const Vec3 p(0.5, 0.5, 0.5);
  const double before = field.size(left_volume, p);
  ASSERT_LT(before, 1.0);
  // It acts on entities that the first function does not reach.
  field.add(mesh_function({{1, 7}}, {lone_surface}));
  EXPECT_EQ(field.size(left_volume, p), before);
  EXPECT_EQ(field.size(lone_surface, p), SizeField::no_size);
}

TEST(SizeField, GroupAnswersAsBeforeIfBuildingFails) {
  SizeField field = left_field(grid_options(), 4);
  const Vec3 p(0, 0.5, 0.5);
  const double before = field.size(left_volume, p);
  field.set_sources(0, {end_mesh(left_end, 0.0, 8)});
  field.options().tolerance = -1.0;
  EXPECT_THROW(field.build(), Error);
  EXPECT_EQ(field.size(left_volume, p), before);
  field.options().tolerance = 0.05;
  field.build();
  EXPECT_NEAR(field.size(left_volume, p), end_mesh_size(8), 0.01);
}

TEST(SizeField, UnchangedGroupsAreNotBuiltAgain) {
  int calls = 0;
  FieldOptions options = grid_options();
  options.progress = [&](const std::string&, double) { ++calls; };
  SizeField field = left_field(options, 40);
  EXPECT_GT(calls, 0);
  calls = 0;
  field.build();
  EXPECT_EQ(calls, 0);
}

// ==== Start sizes in another unit

TEST(SizeField, StartSizesReadFromAMeshAreDividedByTheUnit) {
  SizeField field(two_cubes(), exact_options());
  field.add(mesh_function({left_end}, {left_volume}));
  const Vec3 p(0.5, 0.5, 0.5);
  for (const double unit : {2.0, 0.25, 1.0}) {
    // The same facets with other sizes are a change.
    field.set_sources(0, {end_mesh(left_end, 0.0, 4)}, unit);
    field.build();
    // Growth and distances stay in model units.
    EXPECT_NEAR(field.size(left_volume, {0, 0.5, 0.5}), end_mesh_size(4) / unit, 1e-12) << unit;
    EXPECT_NEAR(field.size(left_volume, p), std::min(2.0, end_mesh_size(4) / unit + 0.1), 1e-12)
        << unit;
    EXPECT_EQ(field.groups()[0].size_limit, 2.0);
  }
}

TEST(SizeField, UnitIsOneUnlessGiven) {
  SizeField given(two_cubes(), exact_options());
  given.add(mesh_function({left_end}, {left_volume}));
  given.set_sources(0, {end_mesh(left_end, 0.0, 4)}, 1.0);
  given.build();
  const Vec3 p(0.25, 0.5, 0.5);
  EXPECT_EQ(given.size(left_volume, p), left_field(exact_options()).size(left_volume, p));
}

TEST(SizeField, GivenSizesAreInEveryUnitTheSame) {
  SizeField field(two_cubes(), exact_options());
  field.add(fixed_function({{0, 5}}, {right_volume}, 0.125));
  field.set_sources(0, {point_source({0, 5}, {2, 0, 0})}, 4.0);
  field.build();
  EXPECT_NEAR(field.size({0, 5}, {2, 0, 0}), 0.125, 1e-15);
}

TEST(SizeField, UnitHoldsForAllElementsOfAllSources) {
  FacetedSource quads;
  quads.entity = right_end;
  quads.quads = {{Vec3(2, 0, 0), Vec3(2, 1, 0), Vec3(2, 1, 1), Vec3(2, 0, 1)}};
  FacetedSource segments;
  segments.entity = {1, 7};
  segments.segments = {{Vec3(5, 0, 0), Vec3(5.5, 0, 0)}};
  SizeField field(two_cubes(), exact_options());
  field.add(
      mesh_function({left_end, right_end, {1, 7}}, {left_volume, right_volume, lone_surface}, 2.0));
  field.set_sources(0, {end_mesh(left_end, 0.0, 4), quads, segments}, 2.0);
  field.build();
  EXPECT_NEAR(field.size(left_volume, {0, 0.5, 0.5}), end_mesh_size(4) / 2.0, 1e-12);
  EXPECT_NEAR(field.size(right_volume, {2, 0.5, 0.5}), end_mesh_size(1) / 2.0, 1e-12);
  EXPECT_NEAR(field.size(lone_surface, {5.25, 0, 0}), 0.25, 1e-12);
}

TEST(SizeField, TheSameFacetsInTheSameUnitAreNoChange) {
  int calls = 0;
  FieldOptions options = grid_options();
  options.progress = [&](const std::string&, double) { ++calls; };
  SizeField field(two_cubes(), options);
  field.add(mesh_function({left_end}, {left_volume}));
  field.set_sources(0, {end_mesh(left_end, 0.0, 40)}, 3.0);
  field.build();
  EXPECT_GT(calls, 0);
  calls = 0;
  field.set_sources(0, {end_mesh(left_end, 0.0, 40)}, 3.0);
  field.build();
  EXPECT_EQ(calls, 0);
  field.set_sources(0, {end_mesh(left_end, 0.0, 40)}, 1.5);
  field.build();
  EXPECT_GT(calls, 0);
}

// ==== Trees without grids

TEST(SizeField, TreesAloneAnswerExactlyAndBuildNoGrid) {
  int calls = 0;
  FieldOptions options = grid_options();
  options.progress = [&](const std::string&, double) { ++calls; };
  SizeField field(two_cubes(), options);
  field.add(mesh_function({left_end}, {left_volume}));
  field.add(mesh_function({right_end}, {right_volume}));
  field.set_sources(0, {end_mesh(left_end, 0.0, 40)});
  field.set_sources(1, {end_mesh(right_end, 2.0, 20)});
  field.build_trees();
  EXPECT_EQ(calls, 0);
  for (const SizeField::GroupSummary& group : field.groups()) {
    EXPECT_FALSE(group.has_grid);
    EXPECT_GT(group.facets, 0u);
  }
  const Vec3 p(0.3, 0.4, 0.7);
  EXPECT_NEAR(field.size(left_volume, p), end_mesh_size(40) + 0.06, 1e-12);
  EXPECT_NEAR(field.size(right_volume, {1.5, 0.5, 0.5}), end_mesh_size(20) + 0.1, 1e-12);
}

TEST(SizeField, BuildAfterTreesMakesTheGridsThatAreAskedFor) {
  SizeField field(two_cubes(), grid_options());
  field.add(mesh_function({left_end}, {left_volume}));
  field.add(mesh_function({right_end}, {right_volume}));
  field.set_sources(0, {end_mesh(left_end, 0.0, 4)});
  field.set_sources(1, {end_mesh(right_end, 2.0, 4)});
  field.build_trees();
  field.build({left_volume});
  for (const SizeField::GroupSummary& group : field.groups()) {
    EXPECT_EQ(group.has_grid,
              std::count(group.entities.begin(), group.entities.end(), left_volume));
  }
  field.build();
  for (const SizeField::GroupSummary& group : field.groups()) {
    EXPECT_TRUE(group.has_grid);
  }
}

TEST(SizeField, TreesOfUnchangedGroupsKeepTheirGrids) {
  SizeField field(two_cubes(), grid_options());
  field.add(mesh_function({left_end}, {left_volume}));
  field.add(mesh_function({right_end}, {right_volume}));
  field.set_sources(0, {end_mesh(left_end, 0.0, 4)});
  field.set_sources(1, {end_mesh(right_end, 2.0, 4)});
  field.build();
  field.set_sources(1, {end_mesh(right_end, 2.0, 8)});
  field.build_trees();
  std::size_t with_grid = 0;
  for (const SizeField::GroupSummary& group : field.groups()) {
    const bool changed = std::count(group.functions.begin(), group.functions.end(), 1u) > 0;
    EXPECT_EQ(group.has_grid, !changed);
    with_grid += group.has_grid ? 1 : 0;
  }
  EXPECT_EQ(with_grid, 1u);
  // A grid of the mesh before would answer here.
  EXPECT_NEAR(field.size(right_volume, {2, 0.5, 0.5}), end_mesh_size(8), 1e-12);
  EXPECT_NEAR(field.size(middle, {1, 0.5, 0.5}), end_mesh_size(8) + 0.2, 1e-12);
}

TEST(SizeField, TreesOfFunctionsWithoutSourcesHaveNoEffect) {
  SizeField field(two_cubes(), grid_options());
  field.add(mesh_function({left_end}, {left_volume}));
  field.build_trees();
  EXPECT_EQ(field.size(left_volume, {0.5, 0.5, 0.5}), SizeField::no_size);
  field.set_sources(0, {end_mesh(left_end, 0.0, 4)});
  EXPECT_EQ(field.size(left_volume, {0.5, 0.5, 0.5}), SizeField::no_size);
  field.build_trees();
  EXPECT_NEAR(field.size(left_volume, {0.5, 0.5, 0.5}), end_mesh_size(4) + 0.1, 1e-12);
  field.set_sources(0, {});
  field.build_trees();
  EXPECT_EQ(field.size(left_volume, {0.5, 0.5, 0.5}), SizeField::no_size);
}

// ==== Messages

TEST(SizeField, ProgressTellsWhatIsBuiltAndHowFar) {
  std::vector<std::pair<std::string, double>> told;
  FieldOptions options = grid_options();
  options.progress = [&](const std::string& what, double done) { told.emplace_back(what, done); };
  left_field(options, 40);
  ASSERT_FALSE(told.empty());
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_NE(told[i].first.find("Volume 1"), std::string::npos) << told[i].first;
    EXPECT_GE(told[i].second, i > 0 ? told[i - 1].second : 0.0);
  }
  EXPECT_EQ(told.back().second, 1.0);
}

}  // namespace
}  // namespace meshgrow
