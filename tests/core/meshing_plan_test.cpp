#include "meshing_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "error.h"
#include "random_facets.h"
#include "short_names.h"

namespace meshgrow {
namespace {

using Entities = std::vector<Entity>;
using Functions = std::vector<SizeFunction>;
using Plan = std::vector<MeshingPass>;

Entity point(int tag) { return {0, tag}; }
Entity curve(int tag) { return {1, tag}; }
Entity surface(int tag) { return {2, tag}; }
Entity volume(int tag) { return {3, tag}; }

SizeFunction mesh_function(Entities sources, Entities attachments) {
  SizeFunction function;
  function.sources = std::move(sources);
  function.attachments = std::move(attachments);
  function.size_limit = 1.0;
  return function;
}

SizeFunction fixed_function(Entities sources, Entities attachments) {
  SizeFunction function = mesh_function(std::move(sources), std::move(attachments));
  function.kind = Kind::fixed;
  function.start_size = 0.1;
  return function;
}

// ==== Models

/// What is to be meshed, with its own copy of all that a task refers to.
struct Model {
  Topology topology;
  Functions functions;
  std::set<Entity> meshed;
  std::vector<Entities> together;
  int dim = 3;
  std::map<Entity, Entity> masters = {};
  std::set<Entity> companions = {};

  MeshingTask task() const { return {topology, functions, meshed, together, masters, companions}; }
  Plan plan() const { return plan_meshing(task(), dim); }
};

/// Curves 1 to 3, each with a point of its own, each around the surface of the same tag, each
/// surface around the volume of the same tag: nothing is shared.
Topology three_balls() {
  Topology topology;
  for (int tag = 1; tag <= 3; ++tag) {
    topology.add_entity(point(tag), {});
    topology.add_entity(curve(tag), {point(tag)});
    topology.add_entity(surface(tag), {curve(tag)});
    topology.add_entity(volume(tag), {surface(tag)});
  }
  return topology;
}

/// Surface 1 within curves 1 to 4, curve 5 embedded in it.
Topology square_with_curve() {
  Topology topology;
  Entities lower;
  for (int tag = 1; tag <= 5; ++tag) {
    topology.add_entity(curve(tag), {});
    lower.push_back(curve(tag));
  }
  topology.add_entity(surface(1), lower);
  return topology;
}

/// An entity of a row of boxes along x by its centre, in units of half a box: odd coordinates are
/// those in which it extends.
Entity in_row(int x, int y, int z) { return {x % 2 + y % 2 + z % 2, 1 + z + 3 * (y + 3 * x)}; }

Topology row_of_boxes(int count) {
  Topology topology;
  for (int x = 0; x <= 2 * count; ++x) {
    for (int y = 0; y <= 2; ++y) {
      for (int z = 0; z <= 2; ++z) {
        Entities lower;
        for (const int side : {-1, 1}) {
          if (x % 2 == 1) {
            lower.push_back(in_row(x + side, y, z));
          }
          if (y % 2 == 1) {
            lower.push_back(in_row(x, y + side, z));
          }
          if (z % 2 == 1) {
            lower.push_back(in_row(x, y, z + side));
          }
        }
        topology.add_entity(in_row(x, y, z), lower);
      }
    }
  }
  return topology;
}

// ==== Plans as text

/// A line a pass, functions counted from 1: "0: C1 C2", "1: S1 by 1 2 from C1".
std::string text(const Plan& plan) {
  std::string result;
  for (const MeshingPass& pass : plan) {
    std::string line = std::to_string(pass.stage) + ": " + test::short_names(pass.entities);
    if (pass.attached) {
      line += "by ";
    }
    for (const std::size_t function : pass.functions) {
      line += std::to_string(function + 1) + ' ';
    }
    if (!pass.sources.empty()) {
      line += "from " + test::short_names(pass.sources);
    }
    line.back() = '\n';
    result += line;
  }
  return result;
}

std::string text(const Model& model) {
  std::string result = "dim " + std::to_string(model.dim) + '\n';
  for (const Entity& entity : model.topology.entities()) {
    if (entity.dim > 0) {
      result += test::short_names({entity}) + "over " +
                test::short_names(model.topology.lower(entity)) +
                (model.meshed.count(entity) > 0 ? "meshed\n" : "\n");
    }
  }
  for (const SizeFunction& function : model.functions) {
    result += kind_name(function.kind) + ' ' + test::short_names(function.sources) + "-> " +
              test::short_names(function.attachments) + '\n';
  }
  for (const Entities& curves : model.together) {
    result += "together " + test::short_names(curves) + '\n';
  }
  return result;
}

std::string error_of(const Model& model) {
  try {
    model.plan();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// ==== The header's definition, literally

/// All below, by repeated search until nothing is new.
std::set<Entity> below(const Entities& entities, const Topology& topology) {
  std::set<Entity> result(entities.begin(), entities.end());
  for (std::size_t before = 0; before != result.size();) {
    before = result.size();
    for (const Entity& entity : std::set<Entity>(result)) {
      for (const Entity& lower : topology.lower(entity)) {
        result.insert(lower);
      }
    }
  }
  return result;
}

bool is_open(const Model& model, const Entity& entity) {
  return entity.dim >= 1 && entity.dim <= model.dim && model.meshed.count(entity) == 0;
}

bool acts_on(const Model& model, std::size_t function, const Entity& entity) {
  return below(model.functions[function].attachments, model.topology).count(entity) > 0;
}

/// Whether the entity has to wait for the sources of the function.
bool waits_for(const Model& model, std::size_t function, const Entity& entity) {
  return model.functions[function].kind == Kind::mesh && acts_on(model, function, entity) &&
         below(model.functions[function].sources, model.topology).count(entity) == 0;
}

using Graph = std::map<Entity, std::set<Entity>>;

/// What each open entity has to come after.
Graph dependencies(const Model& model) {
  Graph graph;
  for (const Entity& entity : model.topology.entities()) {
    if (!is_open(model, entity)) {
      continue;
    }
    Entities before = model.topology.lower(entity);
    for (std::size_t i = 0; i < model.functions.size(); ++i) {
      if (waits_for(model, i, entity)) {
        const Entities& sources = model.functions[i].sources;
        before.insert(before.end(), sources.begin(), sources.end());
      }
    }
    for (const Entity& other : before) {
      if (is_open(model, other)) {
        graph[entity].insert(other);
      }
    }
    graph[entity];
  }
  return graph;
}

/// Each entity with all that it has to come after, directly or not. In a cycle an entity comes
/// after itself.
Graph transitive(Graph graph) {
  for (bool changed = true; changed;) {
    changed = false;
    for (auto& [entity, before] : graph) {
      for (const Entity& other : std::set<Entity>(before)) {
        for (const Entity& further : graph[other]) {
          changed = before.insert(further).second || changed;
        }
      }
    }
  }
  return graph;
}

bool is_cyclic(const Graph& all_before) {
  return std::any_of(all_before.begin(), all_before.end(),
                     [](const auto& entry) { return entry.second.count(entry.first) > 0; });
}

void expect_order(const Model& model, const Plan& plan) {
  const Graph graph = dependencies(model);
  std::map<Entity, int> stage_of;
  for (const MeshingPass& pass : plan) {
    EXPECT_FALSE(pass.entities.empty());
    EXPECT_TRUE(std::is_sorted(pass.entities.begin(), pass.entities.end()));
    for (const Entity& entity : pass.entities) {
      EXPECT_EQ(entity.dim, pass.dim);
      EXPECT_TRUE(graph.count(entity) > 0) << entity_name(entity) << " is not to be meshed";
      EXPECT_TRUE(stage_of.emplace(entity, pass.stage).second) << entity_name(entity) << " twice";
    }
  }
  EXPECT_EQ(stage_of.size(), graph.size()) << "an entity is left out";
  for (const auto& [entity, before] : graph) {
    for (const Entity& other : before) {
      EXPECT_LT(stage_of[other], stage_of[entity])
          << entity_name(entity) << " has to come after " << entity_name(other);
    }
  }
}

void expect_stages(const Plan& plan) {
  int stage = -1;
  int dim = 0;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (i == 0 || plan[i].stage != plan[i - 1].stage) {
      EXPECT_EQ(plan[i].stage, ++stage);
      dim = plan[i].dim;
    } else if (dim < 3) {
      EXPECT_TRUE(plan[i - 1].attached && !plan[i].attached);
    }
    EXPECT_EQ(plan[i].dim, dim);
  }
}

/// Effective: of a mesh function some source has a mesh before the stage begins.
void expect_functions_and_sources(const Model& model, const Plan& plan) {
  std::set<Entity> done = model.meshed;
  std::set<std::pair<std::size_t, Entity>> listed;
  for (auto pass = plan.begin(); pass != plan.end(); ++pass) {
    if (pass != plan.begin() && pass->stage != (pass - 1)->stage) {
      for (auto earlier = plan.begin(); earlier != pass; ++earlier) {
        done.insert(earlier->entities.begin(), earlier->entities.end());
      }
    }
    std::set<std::size_t> acting;
    for (const Entity& entity : pass->entities) {
      bool attached = false;
      for (std::size_t i = 0; i < model.functions.size(); ++i) {
        const SizeFunction& function = model.functions[i];
        const bool effective =
            function.kind == Kind::fixed ||
            std::any_of(function.sources.begin(), function.sources.end(),
                        [&](const Entity& source) { return done.count(source) > 0; });
        if (effective && acts_on(model, i, entity)) {
          attached = true;
          acting.insert(i);
        }
      }
      EXPECT_EQ(attached, pass->attached) << entity_name(entity);
    }
    EXPECT_EQ(pass->functions, std::vector<std::size_t>(acting.begin(), acting.end()));
    std::set<Entity> sources;
    for (const std::size_t i : acting) {
      for (const Entity& source : model.functions[i].sources) {
        const bool readable = model.functions[i].kind == Kind::fixed || done.count(source) > 0;
        if (readable && listed.insert({i, source}).second) {
          sources.insert(source);
        }
      }
    }
    EXPECT_EQ(pass->sources, Entities(sources.begin(), sources.end()));
  }
}

/// Surfaces before the last curve are waited for by a curve that comes later; volumes come last.
void expect_surfaces_late(const Model& model, const Plan& plan) {
  const Graph all_before = transitive(dependencies(model));
  for (auto pass = plan.begin(); pass != plan.end(); ++pass) {
    std::set<Entity> awaited;
    bool lower_follow = false;
    for (auto later = pass; later != plan.end(); ++later) {
      if (later->dim < pass->dim) {
        lower_follow = true;
        for (const Entity& entity : later->entities) {
          awaited.insert(all_before.at(entity).begin(), all_before.at(entity).end());
        }
      }
    }
    for (const Entity& entity : pass->entities) {
      EXPECT_TRUE(!lower_follow || awaited.count(entity) > 0) << entity_name(entity);
    }
  }
}

void expect_valid(const Model& model, const Plan& plan) {
  SCOPED_TRACE(text(model) + text(plan));
  expect_order(model, plan);
  expect_stages(plan);
  expect_functions_and_sources(model, plan);
  expect_surfaces_late(model, plan);
}

std::string valid_plan(const Model& model) {
  const Plan plan = model.plan();
  expect_valid(model, plan);
  return text(plan);
}

/// Entities by the stage that meshes them.
std::map<Entity, int> stages(const Plan& plan) {
  std::map<Entity, int> result;
  for (const MeshingPass& pass : plan) {
    for (const Entity& entity : pass.entities) {
      result[entity] = pass.stage;
    }
  }
  return result;
}

// ==== Order without functions

TEST(MeshingPlan, CurvesThenSurfacesThenVolumes) {
  EXPECT_EQ(valid_plan({three_balls(), {}, {}, {}}), "0: C1 C2 C3\n1: S1 S2 S3\n2: V1 V2 V3\n");
}

TEST(MeshingPlan, NothingAboveTheDimensionIsPlanned) {
  EXPECT_EQ(valid_plan({three_balls(), {}, {}, {}, 2}), "0: C1 C2 C3\n1: S1 S2 S3\n");
  EXPECT_EQ(valid_plan({three_balls(), {}, {}, {}, 1}), "0: C1 C2 C3\n");
}

TEST(MeshingPlan, OnlyDimensionsOneToThreeCanBeMeshed) {
  for (const int dim : {-1, 0, 4}) {
    const std::string message = error_of({three_balls(), {}, {}, {}, dim});
    EXPECT_NE(message.find(std::to_string(dim)), std::string::npos) << message;
  }
}

TEST(MeshingPlan, WhatHasAMeshIsLeftOut) {
  EXPECT_EQ(valid_plan({three_balls(), {}, {curve(1), curve(2), surface(2), volume(3)}, {}}),
            "0: C3\n1: S1 S3\n2: V1 V2\n");
  const Topology topology = three_balls();
  const Entities all = topology.entities();
  EXPECT_EQ(valid_plan({topology, {}, {all.begin(), all.end()}, {}}), "");
}

TEST(MeshingPlan, AnEmptyModelNeedsNoPass) { EXPECT_EQ(valid_plan({Topology(), {}, {}, {}}), ""); }

// ==== Sources before what they act on

TEST(MeshingPlan, PremeshedSourceActsFromTheFirstPassOn) {
  EXPECT_EQ(valid_plan({three_balls(),
                        {mesh_function({surface(1)}, {volume(1), volume(2)})},
                        {curve(1), surface(1)},
                        {}}),
            "0: C2 by 1 from S1\n0: C3\n1: S2 by 1\n1: S3\n2: V1 V2 by 1\n2: V3\n");
}

TEST(MeshingPlan, EmbeddedCurveAsSourceOfItsSurface) {
  EXPECT_EQ(valid_plan({square_with_curve(), {mesh_function({curve(5)}, {surface(1)})}, {}, {}}),
            "0: C5\n1: C1 C2 C3 C4 by 1 from C5\n2: S1 by 1\n");
}

TEST(MeshingPlan, EmbeddedCurvesComeBeforeTheirSurface) {
  EXPECT_EQ(valid_plan({square_with_curve(), {}, {curve(1)}, {}}), "0: C2 C3 C4 C5\n1: S1\n");
}

TEST(MeshingPlan, FaceSharedByTwoBoxes) {
  const Entity middle = in_row(2, 1, 1);
  const Model model = {
      row_of_boxes(2), {mesh_function({middle}, {in_row(1, 1, 1), in_row(3, 1, 1)})}, {}, {}};
  const Plan plan = model.plan();
  expect_valid(model, plan);
  ASSERT_EQ(plan.size(), 5u);
  const std::size_t sizes[] = {4, 1, 16, 10, 2};
  for (std::size_t i = 0; i < plan.size(); ++i) {
    EXPECT_EQ(plan[i].entities.size(), sizes[i]);
    EXPECT_EQ(plan[i].attached, i >= 2);
  }
  EXPECT_EQ(plan[1].entities, Entities{middle});
}

TEST(MeshingPlan, ChainOfBoxes) {
  // From the end face through box after box, each growing from the face before.
  Model model = {row_of_boxes(3), {}, {}, {}};
  for (int i = 0; i < 3; ++i) {
    model.functions.push_back(mesh_function({in_row(2 * i, 1, 1)}, {in_row(2 * i + 1, 1, 1)}));
  }
  const Plan plan = model.plan();
  expect_valid(model, plan);
  std::map<Entity, int> stage = stages(plan);
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(stage[in_row(2 * i, 1, 1)], stage[in_row(2 * i + 2, 1, 2)]) << i;
    EXPECT_LT(stage[in_row(2 * i, 1, 1)], stage[in_row(2 * i + 2, 1, 1)]) << i;
  }
  EXPECT_EQ(stage[in_row(1, 1, 1)], stage[in_row(5, 1, 1)]);
}

TEST(MeshingPlan, ChainOfSurfacesAndVolumes) {
  EXPECT_EQ(valid_plan({three_balls(),
                        {mesh_function({surface(1)}, {volume(1), surface(2)}),
                         mesh_function({surface(2)}, {volume(2), surface(3)})},
                        {},
                        {}}),
            "0: C1\n1: S1\n2: C2 by 1 from S1\n3: S2 by 1\n4: C3 by 2 from S2\n5: S3 by 2\n"
            "6: V1 V2 by 1 2\n6: V3\n");
}

TEST(MeshingPlan, EveryPairOfDimensionsOfSourceAndAttachment) {
  const std::map<std::pair<int, int>, std::string> expected = {
      {{1, 1}, "0: C1 C3\n1: C2 by 1 from C1\n2: S1 S2 S3\n3: V1 V2 V3\n"},
      {{1, 2}, "0: C1 C3\n1: C2 by 1 from C1\n2: S2 by 1\n2: S1 S3\n3: V1 V2 V3\n"},
      {{1, 3}, "0: C1 C3\n1: C2 by 1 from C1\n2: S2 by 1\n2: S1 S3\n3: V2 by 1\n3: V1 V3\n"},
      {{2, 1}, "0: C1 C3\n1: S1\n2: C2 by 1 from S1\n3: S2 S3\n4: V1 V2 V3\n"},
      {{2, 2}, "0: C1 C3\n1: S1\n2: C2 by 1 from S1\n3: S2 by 1\n3: S3\n4: V1 V2 V3\n"},
      {{2, 3}, "0: C1 C3\n1: S1\n2: C2 by 1 from S1\n3: S2 by 1\n3: S3\n4: V2 by 1\n4: V1 V3\n"}};
  for (const auto& [dims, plan] : expected) {
    EXPECT_EQ(
        valid_plan({three_balls(), {mesh_function({{dims.first, 1}}, {{dims.second, 2}})}, {}, {}}),
        plan);
  }
}

TEST(MeshingPlan, EveryPairOfDimensionsInTouchingBoxes) {
  // Each curve and face as the source of each entity of the boxes that is not itself.
  const Topology topology = row_of_boxes(2);
  for (const Entity& source : topology.entities()) {
    if (source.dim != 1 && source.dim != 2) {
      continue;
    }
    for (const Entity& attachment : topology.entities()) {
      if (attachment.dim == 0 || attachment == source) {
        continue;
      }
      const Model model = {topology, {mesh_function({source}, {attachment})}, {}, {}};
      const Plan plan = model.plan();
      expect_valid(model, plan);
      ASSERT_FALSE(HasFailure());
      const std::set<Entity> own = below({source}, topology);
      std::map<Entity, int> stage = stages(plan);
      for (const Entity& entity : below({attachment}, topology)) {
        if (entity.dim > 0 && own.count(entity) == 0) {
          ASSERT_GT(stage[entity], stage[source]) << entity_name(entity);
        }
      }
    }
  }
}

TEST(MeshingPlan, SourcesOfOneFunctionDoNotWaitForEachOther) {
  // Both bound what the function acts on, each would wait for the other.
  const Topology topology = row_of_boxes(1);
  const Entity one = in_row(0, 1, 1);
  const Entity other = in_row(2, 1, 1);
  const Model model = {topology, {mesh_function({one, other}, {in_row(1, 1, 1)})}, {}, {}};
  const Plan plan = model.plan();
  expect_valid(model, plan);
  EXPECT_EQ(plan[1].entities, (Entities{one, other}));
  EXPECT_FALSE(plan[1].attached);
  EXPECT_EQ(plan[2].entities.size(), 4u);
  EXPECT_EQ(plan[2].sources, (Entities{one, other}));
}

TEST(MeshingPlan, FixedFunctionsLetNobodyWait) {
  EXPECT_EQ(valid_plan({three_balls(),
                        {fixed_function({surface(2)}, {volume(1)}),
                         fixed_function({volume(1), point(3)}, {surface(2)})},
                        {},
                        {}}),
            "0: C1 C2 by 1 2 from P3 S2 V1\n0: C3\n1: S1 S2 by 1 2\n1: S3\n2: V1 by 1\n"
            "2: V2 V3\n");
}

TEST(MeshingPlan, SourcesAboveTheDimensionAreNotWaitedFor) {
  EXPECT_EQ(valid_plan({three_balls(), {mesh_function({surface(1)}, {curve(2)})}, {}, {}, 1}),
            "0: C1 C2 C3\n");
}

// ==== Passes

TEST(MeshingPlan, SourcesAreListedOnceAFunction) {
  EXPECT_EQ(valid_plan({three_balls(),
                        {mesh_function({curve(1), curve(1)}, {surface(2)}),
                         mesh_function({curve(1), surface(1)}, {surface(2), surface(3)})},
                        {curve(1), surface(1)},
                        {},
                        2}),
            "0: C2 C3 by 1 2 from C1 S1\n1: S2 S3 by 1 2\n");
}

TEST(MeshingPlan, SourcesThatFollowAreListedWhenTheyHaveAMesh) {
  // Surface 2's own curve is acted on, too, by what has a mesh already.
  EXPECT_EQ(valid_plan({three_balls(),
                        {mesh_function({surface(1), surface(2)}, {volume(2), volume(3)})},
                        {curve(1), surface(1)},
                        {}}),
            "0: C2 by 1 from S1\n1: S2 by 1\n2: C3 by 1 from S2\n3: S3 by 1\n4: V2 V3 by 1\n"
            "4: V1\n");
}

TEST(MeshingPlan, SurfacesWaitForAllCurvesUnlessACurveWaitsForThem) {
  // Surface 3 could come along with surface 1 but is not needed by curve 2.
  EXPECT_EQ(valid_plan({three_balls(), {mesh_function({surface(1)}, {curve(2)})}, {}, {}, 2}),
            "0: C1 C3\n1: S1\n2: C2 by 1 from S1\n3: S2 S3\n");
  // Surface 3 comes early for a curve further on.
  EXPECT_EQ(valid_plan({three_balls(),
                        {mesh_function({surface(1)}, {surface(3)}),
                         mesh_function({surface(3)}, {curve(2)})},
                        {},
                        {},
                        2}),
            "0: C1\n1: S1\n2: C3 by 1 from S1\n3: S3 by 1\n4: C2 by 2 from S3\n5: S2\n");
}

TEST(MeshingPlan, VolumesInCavitiesOfOthersHavePassesOfTheirOwn) {
  Topology topology = three_balls();
  topology.add_entity(volume(1), {surface(1), surface(2)});
  EXPECT_EQ(valid_plan({topology, {fixed_function({point(1)}, {volume(1)})}, {}, {}}),
            "0: C1 C2 by 1 from P1\n0: C3\n1: S1 S2 by 1\n1: S3\n2: V2 V3\n2: V1 by 1\n");
}

// ==== Curves of one stage

TEST(MeshingPlan, CurvesThatBelongTogetherComeInOneStage) {
  const Functions functions = {mesh_function({surface(1)}, {curve(2)})};
  EXPECT_EQ(valid_plan({three_balls(), functions, {}, {{curve(2), curve(3)}}, 2}),
            "0: C1\n1: S1\n2: C2 by 1 from S1\n2: C3\n3: S2 S3\n");
}

TEST(MeshingPlan, CurvesTogetherWaitForWhatAnyOfThemWaitsFor) {
  Topology topology = three_balls();
  topology.add_entity(curve(4), {});
  topology.add_entity(curve(5), {});
  const Functions functions = {mesh_function({surface(1)}, {curve(2)}),
                               mesh_function({curve(5)}, {curve(4)})};
  EXPECT_EQ(valid_plan({topology, functions, {}, {{curve(4), curve(2), curve(3)}}, 1}),
            "0: C1 C5\n1: C4 by 2 from C5\n1: C2 C3\n");
  EXPECT_EQ(valid_plan({topology, functions, {}, {{curve(4), curve(2)}}, 2}),
            "0: C1 C3 C5\n1: S1\n2: C2 C4 by 1 2 from C5 S1\n3: S2 S3\n");
}

TEST(MeshingPlan, CurvesOfWhichOneAwaitsAnotherAreNotKeptTogether) {
  const Functions functions = {mesh_function({curve(1)}, {curve(2)})};
  EXPECT_EQ(valid_plan({three_balls(), functions, {}, {{curve(1), curve(2)}}, 1}),
            "0: C1 C3\n1: C2 by 1 from C1\n");
  // Through a surface.
  EXPECT_EQ(valid_plan({three_balls(),
                        {mesh_function({surface(1)}, {curve(2)})},
                        {},
                        {{curve(1), curve(2)}},
                        1}),
            "0: C1 C2 C3\n");
  EXPECT_EQ(valid_plan({three_balls(),
                        {mesh_function({surface(1)}, {curve(2)})},
                        {},
                        {{curve(2), curve(1)}},
                        2}),
            "0: C1 C3\n1: S1\n2: C2 by 1 from S1\n3: S2 S3\n");
}

TEST(MeshingPlan, CurvesWithAMeshDoNotHoldUpWhatBelongsToThem) {
  EXPECT_EQ(valid_plan({three_balls(),
                        {mesh_function({surface(1)}, {curve(2)})},
                        {curve(2)},
                        {{curve(2), curve(3), curve(99)}},
                        2}),
            "0: C1 C3\n1: S1 S2 S3\n");
}

// ==== Cycles

constexpr const char* intro = "The size functions wait for each other: ";

TEST(MeshingPlan, APeriodicCopyComesAfterItsMasterAndWaitsForNoSource) {
  Model model{three_balls(), {mesh_function({curve(1)}, {surface(2)})}, {}, {}, 1};
  const auto stage_of = [](const Plan& plan, const Entity& entity) {
    for (const MeshingPass& pass : plan) {
      if (std::count(pass.entities.begin(), pass.entities.end(), entity) > 0) {
        return pass.stage;
      }
    }
    return -1;
  };
  EXPECT_LT(stage_of(model.plan(), curve(3)), stage_of(model.plan(), curve(2)));
  model.masters = {{curve(2), curve(3)}};
  EXPECT_LT(stage_of(model.plan(), curve(3)), stage_of(model.plan(), curve(2)));
  model.masters = {{curve(3), curve(2)}};
  EXPECT_LT(stage_of(model.plan(), curve(1)), stage_of(model.plan(), curve(2)));
  EXPECT_LT(stage_of(model.plan(), curve(2)), stage_of(model.plan(), curve(3)));
  model.masters = {{curve(2), curve(3)}, {curve(3), curve(2)}};
  EXPECT_THROW(model.plan(), Error);
}

TEST(MeshingPlan, CompanionsWaitForNoSourceAndCountAsAwaited) {
  // Surface 3 and its curve would wait for surface 1, and all surfaces for all curves.
  Model model{three_balls(), {mesh_function({surface(1)}, {volume(2), volume(3)})}, {}, {}, 2};
  model.companions = {curve(3), surface(3)};
  const Plan plan = model.plan();
  ASSERT_GE(plan.size(), 2U);
  EXPECT_EQ(plan[0].entities, (Entities{curve(1), curve(3)}));
  EXPECT_EQ(plan[1].entities, (Entities{surface(1), surface(3)}));
}

TEST(MeshingPlan, CycleOfTwo) {
  EXPECT_EQ(error_of({three_balls(),
                      {mesh_function({surface(1)}, {surface(2)}),
                       mesh_function({surface(2)}, {surface(1)})},
                      {},
                      {}})
                .find(std::string(intro) +
                      "Surface 1 grows from Surface 2 by Mesh size function 2, which grows from "
                      "Surface 1 by Mesh size function 1; mesh one of them"),
            0u);
}

TEST(MeshingPlan, CycleOfThreeAmongOthers) {
  EXPECT_EQ(
      error_of(
          {three_balls(),
           {fixed_function({surface(1)}, {surface(2)}), mesh_function({surface(3)}, {surface(2)}),
            mesh_function({surface(2)}, {surface(1)}), mesh_function({surface(1)}, {surface(3)})},
           {},
           {}})
          .find(std::string(intro) +
                "Surface 1 grows from Surface 2 by Mesh size function 3, which grows from "
                "Surface 3 by Mesh size function 2, which grows from Surface 1 by Mesh size "
                "function 4; "),
      0u);
}

TEST(MeshingPlan, CycleOfCurves) {
  EXPECT_EQ(
      error_of({three_balls(),
                {mesh_function({curve(1)}, {curve(2)}), mesh_function({curve(2)}, {surface(1)})},
                {},
                {}})
          .find(std::string(intro) +
                "Curve 1 grows from Curve 2 by Mesh size function 2, which grows from Curve 1 by "
                "Mesh size function 1; "),
      0u);
}

TEST(MeshingPlan, CycleThroughBoundaries) {
  EXPECT_EQ(
      error_of({three_balls(),
                {mesh_function({surface(1)}, {curve(2)}), mesh_function({surface(2)}, {curve(1)})},
                {},
                {}})
          .find(std::string(intro) +
                "Surface 1 grows from Surface 2 by Mesh size function 2 (at its Curve 1), "
                "which grows from Surface 1 by Mesh size function 1 (at its Curve 2); "),
      0u);
}

TEST(MeshingPlan, CycleThatEndsAtABoundary) {
  // Curve 1 is a source and bounds the last surface.
  EXPECT_EQ(
      error_of({three_balls(),
                {mesh_function({curve(1)}, {curve(3)}), mesh_function({surface(2)}, {curve(1)}),
                 mesh_function({surface(1)}, {surface(2)})},
                {},
                {}})
          .find(std::string(intro) +
                "Curve 1 grows from Surface 2 by Mesh size function 2, which grows from "
                "Surface 1 by Mesh size function 3, which Curve 1 bounds; "),
      0u);
}

TEST(MeshingPlan, AMeshOnTheCycleBreaksIt) {
  const Functions functions = {mesh_function({surface(1)}, {surface(2)}),
                               mesh_function({surface(2)}, {surface(1)})};
  EXPECT_EQ(valid_plan({three_balls(), functions, {curve(1), surface(1)}, {}, 2}),
            "0: C2 by 1 from S1\n0: C3\n1: S2 by 1\n1: S3\n");
  const Functions one = {mesh_function({surface(1), surface(2)}, {surface(1), surface(2)})};
  EXPECT_EQ(valid_plan({three_balls(), one, {}, {}, 2}), "0: C1 C2 C3\n1: S1 S2 S3\n");
}

TEST(MeshingPlan, CycleAboveTheDimensionIsNone) {
  EXPECT_EQ(valid_plan({three_balls(),
                        {mesh_function({surface(1)}, {surface(2)}),
                         mesh_function({surface(2)}, {surface(1)})},
                        {},
                        {},
                        1}),
            "0: C1 C2 C3\n");
}

// ==== As a table

TEST(MeshingPlan, TextNamesPassesFunctionsAndSources) {
  const Model model = {three_balls(), {mesh_function({curve(1)}, {surface(2)})}, {}, {}, 2};
  EXPECT_EQ(plan_text(model.plan(), model.functions),
            "Pass 1: dimension 1, Curve 1 and Curve 3\n    Gmsh's own sizes\n"
            "Pass 2: dimension 1, Curve 2\n    sizes from Mesh size function 1\n"
            "    reads Curve 1\n"
            "Pass 3: dimension 2, Surface 2\n    sizes from Mesh size function 1\n"
            "Pass 4: dimension 2, Surface 1 and Surface 3\n    Gmsh's own sizes\n");
  EXPECT_NE(plan_text({}, {}).find("Nothing to mesh"), std::string::npos);
}

// ==== Random models

Entities random_choice(test::Random& random, const Entities& from, std::size_t most) {
  Entities result;
  for (std::size_t i = 1 + test::random_index(random, most); i > 0; --i) {
    result.push_back(from[test::random_index(random, from.size())]);
  }
  return result;
}

/// Small, so that cycles are about as frequent as none; boundaries need not close.
Model random_model(test::Random& random) {
  Model model;
  Entities all[4];
  const std::size_t most[4] = {2, 6, 5, 2};
  for (int dim = 0; dim <= 3; ++dim) {
    const std::size_t count = 1 + test::random_index(random, most[dim]);
    for (std::size_t i = 1; i <= count; ++i) {
      const Entity entity = {dim, static_cast<int>(i)};
      Entities lower;
      if (dim > 0) {
        lower = random_choice(random, all[dim - 1], 3);
      }
      if (dim > 1 && test::random_index(random, 3) == 0) {
        lower.push_back(random_choice(random, all[dim - 2 + test::random_index(random, 2)], 1)[0]);
      }
      std::sort(lower.begin(), lower.end());
      lower.erase(std::unique(lower.begin(), lower.end()), lower.end());
      model.topology.add_entity(entity, lower);
      all[dim].push_back(entity);
    }
  }
  const std::size_t function_count = test::random_index(random, 7);
  while (model.functions.size() < function_count) {
    const auto any = [&](int low, int high) {
      return all[low + static_cast<int>(test::random_index(random, high - low + 1))];
    };
    const bool is_fixed = test::random_index(random, 4) == 0;
    SizeFunction function = is_fixed ? fixed_function(random_choice(random, any(0, 3), 2), {})
                                     : mesh_function(random_choice(random, any(1, 2), 2), {});
    function.attachments = random_choice(random, any(1, 3), 2);
    try {
      validate(function, "", model.topology);
      model.functions.push_back(function);
    } catch (const Error&) {
      // A source that is its own attachment: try again.
    }
  }
  const bool premeshed = test::random_index(random, 2) == 0;
  for (const Entity& entity : model.topology.entities()) {
    if (premeshed && entity.dim > 0 && test::random_index(random, 5) == 0) {
      model.meshed.insert(entity);
    }
  }
  if (test::random_index(random, 2) == 0) {
    Entities curves = all[1];
    std::shuffle(curves.begin(), curves.end(), random);
    const std::size_t half = curves.size() / 2;
    model.together.push_back({curves.begin(), curves.begin() + half});
    if (test::random_index(random, 2) == 0) {
      model.together.push_back({curves.begin() + half, curves.end()});
    }
  }
  model.dim = 3 - static_cast<int>(test::random_index(random, 6)) / 3;
  return model;
}

Entity named(const std::string& name) {
  for (int dim = 0; dim <= 3; ++dim) {
    const std::string word = dimension_name(dim) + ' ';
    if (name.compare(0, word.size(), word) == 0) {
      return {dim, std::stoi(name.substr(word.size()))};
    }
  }
  ADD_FAILURE() << name << " is no entity";
  return {};
}

/// The message has the one form of a sentence, each step of it is true, and it ends where it began.
void expect_true_cycle(const Model& model, const std::string& message) {
  const std::string name = "((?:Curve|Surface) \\d+)";
  const std::string step =
      "grows from " + name + " by Mesh size function (\\d+)(?: \\(at its " + name + "\\))?";
  std::smatch parts;
  ASSERT_TRUE(std::regex_match(
      message, parts,
      std::regex(std::string(intro) + name + " (" + step + "(?:, which " + step + ")*)(?:, which " +
                 name +
                 " bounds)?; mesh one of them beforehand, attach less, or name them as "
                 "sources of one function\\.")));
  const Entity start = named(parts[1]);
  const std::string last_bound = parts[parts.size() - 1];
  const std::string steps = parts[2];
  Entity at = start;
  const std::regex pattern(step);
  for (std::sregex_iterator found(steps.begin(), steps.end(), pattern), end; found != end;
       ++found) {
    const Entity source = named((*found)[1]);
    const std::size_t function = std::stoul((*found)[2]) - 1;
    Entity waiting = at;
    if ((*found)[3].matched) {
      waiting = named((*found)[3]);
      const Entities& lower = model.topology.lower(at);
      EXPECT_TRUE(std::count(lower.begin(), lower.end(), waiting) > 0) << entity_name(waiting);
    }
    ASSERT_LT(function, model.functions.size());
    EXPECT_TRUE(waits_for(model, function, waiting)) << entity_name(waiting);
    const Entities& sources = model.functions[function].sources;
    EXPECT_TRUE(std::count(sources.begin(), sources.end(), source) > 0) << entity_name(source);
    EXPECT_TRUE(is_open(model, source) && is_open(model, waiting));
    at = source;
  }
  if (!last_bound.empty()) {
    EXPECT_EQ(named(last_bound), start);
    const Entities& lower = model.topology.lower(at);
    EXPECT_TRUE(std::count(lower.begin(), lower.end(), start) > 0) << entity_name(at);
  } else {
    EXPECT_EQ(at, start);
  }
}

/// The first of several sets may stand in the way of the others.
void expect_first_set_together(const Model& model, const Plan& plan) {
  if (model.together.empty()) {
    return;
  }
  const Graph all_before = transitive(dependencies(model));
  const std::map<Entity, int> stage_of = stages(plan);
  std::set<int> of_set;
  for (const Entity& entity : model.together.front()) {
    if (!is_open(model, entity)) {
      continue;
    }
    of_set.insert(stage_of.at(entity));
    for (const Entity& other : model.together.front()) {
      if (all_before.at(entity).count(other) > 0) {
        return;
      }
    }
  }
  EXPECT_LE(of_set.size(), 1u) << text(model) << text(plan);
}

TEST(MeshingPlan, RandomModelsArePlannedUnlessTheyHaveACycle) {
  constexpr unsigned seed = 1;
  test::Random random(seed);
  constexpr int rounds = 3000;
  int cyclic = 0;
  int long_plans = 0;
  for (int round = 0; round < rounds; ++round) {
    const Model model = random_model(random);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round) + "\n" +
                 text(model));
    if (is_cyclic(transitive(dependencies(model)))) {
      ++cyclic;
      const std::string message = error_of(model);
      ASSERT_NE(message, "") << "a cycle was planned";
      SCOPED_TRACE(message);
      expect_true_cycle(model, message);
      ASSERT_EQ(error_of(model), message);
      ASSERT_FALSE(HasFailure());
      continue;
    }
    ASSERT_EQ(error_of(model), "");
    const Plan plan = model.plan();
    expect_valid(model, plan);
    expect_first_set_together(model, plan);
    ASSERT_EQ(text(model.plan()), text(plan)) << "planned again";
    ASSERT_FALSE(HasFailure());
    // After any of its stages the rest is planned as well, and nothing else.
    const int stage_count = plan.empty() ? 0 : plan.back().stage + 1;
    long_plans += stage_count > 4 ? 1 : 0;
    Model rest = model;
    for (int stage = 0; stage < stage_count; ++stage) {
      for (const MeshingPass& pass : plan) {
        if (pass.stage == stage) {
          rest.meshed.insert(pass.entities.begin(), pass.entities.end());
        }
      }
      expect_valid(rest, rest.plan());
      ASSERT_FALSE(HasFailure()) << "after stage " << stage;
    }
    EXPECT_TRUE(rest.plan().empty());
  }
  EXPECT_GT(cyclic, rounds / 10);
  EXPECT_LT(cyclic, rounds / 2);
  EXPECT_GT(long_plans, rounds / 10);
}

}  // namespace
}  // namespace meshgrow
