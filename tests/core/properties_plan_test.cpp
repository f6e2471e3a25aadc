// What holds of the order of meshing, whatever the model and its functions are.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "error.h"
#include "meshing_plan.h"
#include "property_rounds.h"
#include "short_names.h"

namespace meshgrow {
namespace {

using test::Random;
using test::random_index;

using Entities = std::vector<Entity>;
using Plan = std::vector<MeshingPass>;

// ==== Random models

struct PlanModel {
  Topology topology;
  std::vector<SizeFunction> functions;
  std::set<Entity> meshed = {};
  std::vector<Entities> together = {};
  std::map<Entity, Entity> masters = {};
  std::set<Entity> companions = {};
  int dim = 3;

  Plan plan() const {
    return plan_meshing({topology, functions, meshed, together, masters, companions}, dim);
  }
};

/// A block of boxes, some left out, with curves embedded in faces and volumes. An entity stands at
/// its centre, in units of half a box: it extends along the axes of its odd coordinates.
Topology random_block(Random& random) {
  std::array<int, 3> boxes{};
  for (int& count : boxes) {
    count = 1 + static_cast<int>(random_index(random, 2));
  }
  using Place = std::array<int, 3>;
  const auto dim_of = [](const Place& at) { return at[0] % 2 + at[1] % 2 + at[2] % 2; };
  const auto entity_at = [&](const Place& at) {
    return Entity{dim_of(at), 1 + at[2] + 5 * (at[1] + 5 * at[0])};
  };
  std::map<Entity, Entities> lower;
  const auto add = [&](const auto& self, const Place& at) -> void {
    Entities& below = lower[entity_at(at)];
    if (!below.empty()) {
      return;
    }
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {-1, 1}) {
        Place face = at;
        face[axis] += side;
        if (at[axis] % 2 == 1) {
          lower[entity_at(at)].push_back(entity_at(face));
          self(self, face);
        }
      }
    }
  };
  for (int x = 0; x < boxes[0]; ++x) {
    for (int y = 0; y < boxes[1]; ++y) {
      for (int z = 0; z < boxes[2]; ++z) {
        if ((x == 0 && y == 0 && z == 0) || random_index(random, 4) > 0) {
          add(add, {2 * x + 1, 2 * y + 1, 2 * z + 1});
        }
      }
    }
  }
  Entities hosts;
  for (const auto& [entity, below] : lower) {
    if (entity.dim >= 2) {
      hosts.push_back(entity);
    }
  }
  for (int i = static_cast<int>(random_index(random, 3)); i > 0; --i) {
    lower[{1, 1000 + i}] = {};
    lower[hosts[random_index(random, hosts.size())]].push_back({1, 1000 + i});
  }
  Topology topology;
  for (const auto& [entity, below] : lower) {
    topology.add_entity(entity, below);
  }
  return topology;
}

Entities some_of(Random& random, Entities from, std::size_t most) {
  std::shuffle(from.begin(), from.end(), random);
  from.resize(std::min(from.size(), 1 + random_index(random, most)));
  return from;
}

SizeFunction random_function(Random& random, const Topology& topology) {
  for (;;) {
    SizeFunction function;
    function.kind = random_index(random, 4) == 0 ? Kind::fixed : Kind::mesh;
    function.size_limit = 1.0;
    function.start_size = 0.1;
    const int source_dim = 1 + static_cast<int>(random_index(random, 2));
    const int most = 3 - source_dim + 1;
    const int attach_dim = source_dim + static_cast<int>(random_index(random, most));
    function.sources = some_of(random, topology.entities(source_dim), 3);
    function.attachments = some_of(random, topology.entities(attach_dim), 2);
    try {
      validate(function, "", topology);
      return function;
    } catch (const Error&) {
      // A source that is its own attachment: draw again.
    }
  }
}

PlanModel random_plan_model(Random& random) {
  PlanModel model;
  model.topology = random_block(random);
  for (std::size_t i = random_index(random, 5); i > 0; --i) {
    model.functions.push_back(random_function(random, model.topology));
  }
  if (random_index(random, 2) == 0) {
    for (const Entity& entity : model.topology.entities()) {
      if (entity.dim > 0 && random_index(random, 6) == 0) {
        model.meshed.insert(entity);
      }
    }
  }
  if (random_index(random, 3) == 0) {
    const Entities pair = some_of(random, model.topology.entities(1), 4);
    if (pair.size() >= 2) {
      model.masters[pair[0]] = pair[1];
    }
  }
  if (random_index(random, 3) == 0) {
    model.companions.insert(some_of(random, model.topology.entities(2), 1).front());
  }
  model.dim = 1 + static_cast<int>(random_index(random, 3));
  return model;
}

// ==== Plans as text

std::string text_of(const Plan& plan) {
  std::string text;
  for (const MeshingPass& pass : plan) {
    text += std::to_string(pass.stage) + ": " + test::short_names(pass.entities) +
            (pass.attached ? "by " : "alone ");
    for (const std::size_t function : pass.functions) {
      text += std::to_string(function) + ' ';
    }
    text += "from " + test::short_names(pass.sources) + '\n';
  }
  return text;
}

std::string text_of(const PlanModel& model) {
  std::string text = "dim " + std::to_string(model.dim) + '\n';
  for (const Entity& entity : model.topology.entities()) {
    text += test::short_names({entity}) + "over " +
            test::short_names(model.topology.lower(entity)) + '\n';
  }
  for (const SizeFunction& function : model.functions) {
    text += kind_name(function.kind) + ' ' + test::short_names(function.sources) + "-> " +
            test::short_names(function.attachments) + '\n';
  }
  return text + "meshed " + test::short_names({model.meshed.begin(), model.meshed.end()}) + '\n';
}

/// "cycle" where the functions wait for each other.
std::string plan_or_cycle(const PlanModel& model) {
  try {
    return text_of(model.plan());
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("wait for each other"), std::string::npos)
        << error.what();
    return "cycle";
  }
}

/// Calls `check(random, model, plan)` for random models, unless their functions wait for each
/// other.
template <typename Check>
void for_planned_models(std::uint64_t rounds, Check check) {
  test::for_random_rounds(rounds, [&check](Random& random) {
    const PlanModel model = random_plan_model(random);
    if (plan_or_cycle(model) != "cycle") {
      SCOPED_TRACE(text_of(model));
      check(random, model, model.plan());
    }
  });
}

TEST(PlanProperties, ModelsArePlannedOnceAndWaitForEachOtherOnce) {
  // Guards the tests around it, most of which say nothing about cycles.
  Random random(1);
  int cycles = 0;
  int long_plans = 0;
  for (int i = 0; i < 500; ++i) {
    const PlanModel model = random_plan_model(random);
    const bool is_cycle = plan_or_cycle(model) == "cycle";
    cycles += is_cycle ? 1 : 0;
    long_plans += !is_cycle && !model.plan().empty() && model.plan().back().stage > 3 ? 1 : 0;
  }
  EXPECT_GT(cycles, 20);
  EXPECT_LT(cycles, 250);
  EXPECT_GT(long_plans, 50);
}

// ==== Planning again

TEST(PlanProperties, TheSameModelIsPlannedTheSameAndNothingIsLeftAfterIt) {
  for_planned_models(500, [](Random&, const PlanModel& model, const Plan& plan) {
    EXPECT_EQ(text_of(model.plan()), text_of(plan));
    PlanModel done = model;
    for (const MeshingPass& pass : plan) {
      for (const Entity& entity : pass.entities) {
        EXPECT_TRUE(done.meshed.insert(entity).second) << entity_name(entity) << " again";
      }
    }
    for (const Entity& entity : model.topology.entities()) {
      EXPECT_TRUE(entity.dim < 1 || entity.dim > model.dim || done.meshed.count(entity) > 0)
          << entity_name(entity) << " is left out";
    }
    EXPECT_EQ(text_of(done.plan()), "");
  });
}

/// Stages from `first` on, counted from 0, and what they read anew: all that they read.
std::string rest_of(const Plan& plan, int first) {
  Plan rest;
  for (MeshingPass pass : plan) {
    if (pass.stage >= first) {
      pass.stage -= first;
      pass.sources.clear();
      rest.push_back(std::move(pass));
    }
  }
  return text_of(rest);
}

TEST(PlanProperties, WhoStopsAfterAnyStageGoesOnAsPlanned) {
  for_planned_models(500, [](Random&, const PlanModel& model, const Plan& plan) {
    PlanModel rest = model;
    for (std::size_t i = 0; i < plan.size(); ++i) {
      rest.meshed.insert(plan[i].entities.begin(), plan[i].entities.end());
      if (i + 1 == plan.size() || plan[i + 1].stage > plan[i].stage) {
        EXPECT_EQ(rest_of(rest.plan(), 0), rest_of(plan, plan[i].stage + 1))
            << "after stage " << plan[i].stage;
      }
    }
  });
}

// ==== The same model told otherwise

TEST(PlanProperties, DoesNotDependOnTheOrderInWhichEntitiesAreNamed) {
  test::for_random_rounds(500, [](Random& random) {
    PlanModel model = random_plan_model(random);
    model.together.push_back(some_of(random, model.topology.entities(1), 4));
    SCOPED_TRACE(text_of(model));
    const std::string expected = plan_or_cycle(model);
    for (SizeFunction& function : model.functions) {
      function.sources.push_back(function.sources[random_index(random, function.sources.size())]);
      std::shuffle(function.sources.begin(), function.sources.end(), random);
      std::shuffle(function.attachments.begin(), function.attachments.end(), random);
      function.attachments.push_back(function.attachments.front());
    }
    std::shuffle(model.together.front().begin(), model.together.front().end(), random);
    Topology topology;
    for (const Entity& entity : model.topology.entities()) {
      Entities lower = model.topology.lower(entity);
      std::shuffle(lower.begin(), lower.end(), random);
      topology.add_entity(entity, lower);
    }
    model.topology = topology;
    EXPECT_EQ(plan_or_cycle(model), expected);
  });
}

TEST(PlanProperties, DoesNotDependOnTheOrderOfFunctions) {
  test::for_random_rounds(500, [](Random& random) {
    PlanModel model = random_plan_model(random);
    SCOPED_TRACE(text_of(model));
    const std::string expected = plan_or_cycle(model);
    const std::vector<SizeFunction> original = model.functions;
    std::vector<std::size_t> order(original.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      order[i] = i;
    }
    std::shuffle(order.begin(), order.end(), random);
    for (std::size_t i = 0; i < order.size(); ++i) {
      model.functions[i] = original[order[i]];
    }
    if (plan_or_cycle(model) == "cycle") {
      EXPECT_EQ(expected, "cycle");
      return;
    }
    Plan plan = model.plan();
    for (MeshingPass& pass : plan) {
      for (std::size_t& function : pass.functions) {
        function = order[function];
      }
      std::sort(pass.functions.begin(), pass.functions.end());
    }
    EXPECT_EQ(text_of(plan), expected);
  });
}

/// The same model with other tags: a permutation for each dimension.
TEST(PlanProperties, DoesNotDependOnTags) {
  test::for_random_rounds(500, [](Random& random) {
    const PlanModel model = random_plan_model(random);
    SCOPED_TRACE(text_of(model));
    std::map<Entity, Entity> renamed;
    for (int dim = 0; dim <= 3; ++dim) {
      Entities shuffled = model.topology.entities(dim);
      std::shuffle(shuffled.begin(), shuffled.end(), random);
      std::size_t i = 0;
      for (const Entity& entity : model.topology.entities(dim)) {
        renamed[entity] = shuffled[i++];
      }
    }
    const auto rename_all = [&renamed](Entities& entities) {
      for (Entity& entity : entities) {
        entity = renamed.at(entity);
      }
      std::sort(entities.begin(), entities.end());
    };
    PlanModel other;
    other.dim = model.dim;
    for (const auto& [entity, new_entity] : renamed) {
      Entities lower = model.topology.lower(entity);
      rename_all(lower);
      other.topology.add_entity(new_entity, lower);
    }
    other.functions = model.functions;
    for (SizeFunction& function : other.functions) {
      rename_all(function.sources);
      rename_all(function.attachments);
    }
    for (const Entity& entity : model.meshed) {
      other.meshed.insert(renamed.at(entity));
    }
    for (const auto& [copy, master] : model.masters) {
      other.masters[renamed.at(copy)] = renamed.at(master);
    }
    for (const Entity& entity : model.companions) {
      other.companions.insert(renamed.at(entity));
    }
    if (plan_or_cycle(model) == "cycle") {
      EXPECT_EQ(plan_or_cycle(other), "cycle");
      return;
    }
    Plan plan = model.plan();
    for (MeshingPass& pass : plan) {
      rename_all(pass.entities);
      rename_all(pass.sources);
    }
    EXPECT_EQ(plan_or_cycle(other), text_of(plan));
  });
}

}  // namespace
}  // namespace meshgrow
