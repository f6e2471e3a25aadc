// What holds of combined size functions, in memory and in files.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "brute_force.h"
#include "error.h"
#include "field_file.h"
#include "property_rounds.h"
#include "random_models.h"
#include "size_field.h"
#include "size_function_text.h"
#include "test_with_folder.h"

namespace meshgrow {
namespace {

using test::Random;
using test::text_of;

using Entities = std::vector<Entity>;

// ==== Random fields

constexpr int box_count = 3;

/// Unit cubes in a row along x: volumes 1 to 3, faces 0 to 3 across x, each with one curve around
/// it, and one surface around the rest of each cube, 11 to 13.
Topology row_of_cubes() {
  Topology topology;
  const auto slab = [](int from, int to) { return Box(Vec3(from, 0, 0), Vec3(to, 1, 1)); };
  for (int i = 0; i <= box_count; ++i) {
    topology.add_entity({0, i + 1}, {}, Box(Vec3(i, 0, 0), Vec3(i, 0, 0)));
    topology.add_entity({1, i + 1}, {{0, i + 1}}, slab(i, i));
    topology.add_entity({2, i + 1}, {{1, i + 1}}, slab(i, i));
  }
  for (int i = 1; i <= box_count; ++i) {
    topology.add_entity({2, 10 + i}, {{1, i}, {1, i + 1}}, slab(i - 1, i));
    topology.add_entity({3, i}, {{2, i}, {2, i + 1}, {2, 10 + i}}, slab(i - 1, i));
  }
  return topology;
}

/// Points, segments, triangles and quads within the entity's box; not a mesh, but as good as one.
FacetedSource random_source(Random& random, const Entity& entity, const Topology& topology) {
  FacetedSource source;
  source.entity = entity;
  const Box& box = topology.box(entity);
  for (std::size_t i = 1 + test::random_index(random, 20); i > 0; --i) {
    const double size = test::log_uniform(random, 1e-3, 0.3);
    const Vec3 a = test::random_in_box(random, box);
    const Vec3 b = a + size * test::random_direction(random);
    const Vec3 c = a + size * test::random_direction(random);
    if (entity.dim == 0) {
      source.points.push_back(a);
    } else if (entity.dim == 1) {
      source.segments.push_back({a, b});
    } else if (test::random_index(random, 4) == 0) {
      source.quads.push_back({a, b, Vec3(b + (c - a)), c});
    } else {
      source.triangles.push_back({a, b, c});
    }
  }
  return source;
}

/// A function, and the pieces of its sources.
struct Drawn {
  SizeFunction function;
  std::vector<FacetedSource> sources;
};

Entities random_entities(Random& random, const Topology& topology, int lowest, int highest) {
  Entities all;
  for (const Entity& entity : topology.entities()) {
    if (entity.dim >= lowest && entity.dim <= highest) {
      all.push_back(entity);
    }
  }
  std::shuffle(all.begin(), all.end(), random);
  all.resize(1 + test::random_index(random, 3));
  return all;
}

Drawn random_function(Random& random, const Topology& topology) {
  for (;;) {
    Drawn drawn;
    SizeFunction& function = drawn.function;
    function.kind = test::random_index(random, 2) == 0 ? Kind::mesh : Kind::fixed;
    const bool is_fixed = function.kind == Kind::fixed;
    function.sources = random_entities(random, topology, is_fixed ? 0 : 1, is_fixed ? 3 : 2);
    function.attachments = random_entities(random, topology, 1, 3);
    function.growth_rate = test::random_growth_rate(random);
    function.size_limit = test::log_uniform(random, 1e-2, 10.0);
    function.start_size = is_fixed ? test::log_uniform(random, 1e-3, 1.0) : 0.0;
    if (test::random_index(random, 2) == 0) {
      function.quad_size = is_fixed ? function.quad_size : QuadSize::sides;
    }
    try {
      validate(function, "", topology);
    } catch (const Error&) {
      continue;  // a source that is its own attachment
    }
    const bool has_pieces = test::random_index(random, 8) > 0;
    for (const Entity& entity : function.sources) {
      if (has_pieces) {
        drawn.sources.push_back(random_source(random, entity, topology));
      }
    }
    return drawn;
  }
}

std::vector<Drawn> random_functions(Random& random, const Topology& topology) {
  std::vector<Drawn> functions(1 + test::random_index(random, 5));
  for (Drawn& drawn : functions) {
    drawn = random_function(random, topology);
  }
  return functions;
}

SizeField field_of(const std::vector<Drawn>& functions, Evaluator evaluator) {
  FieldOptions options;
  options.evaluator = evaluator;
  options.threads = 1;
  SizeField field(row_of_cubes(), options);
  for (const Drawn& drawn : functions) {
    const std::size_t index = field.add(drawn.function);
    field.set_sources(index, drawn.sources);
  }
  field.build();
  return field;
}

std::string text_of(const std::vector<Drawn>& functions) {
  std::string text;
  for (const Drawn& drawn : functions) {
    text += size_function_text(drawn.function) + (drawn.sources.empty() ? " (no mesh)\n" : "\n");
  }
  return text;
}

std::vector<Vec3> random_points(Random& random, std::size_t count) {
  std::vector<Vec3> points;
  while (points.size() < count) {
    Vec3 p = test::random_in_box(random, Box(Vec3(-0.5, -0.5, -0.5), Vec3(3.5, 1.5, 1.5)));
    for (double& x : p) {
      x = test::random_index(random, 4) == 0 ? std::round(x) : x;
    }
    points.push_back(test::random_index(random, 20) == 0 ? Vec3(1e5 * p) : p);
  }
  return points;
}

// ==== The definition, literally

double mean_of_sides(const std::vector<Vec3>& corners) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    sum += (corners[(i + 1) % corners.size()] - corners[i]).norm();
  }
  return sum / static_cast<double>(corners.size());
}

double function_size(const Drawn& drawn, const Vec3& p, bool inside_source) {
  const SizeFunction& function = drawn.function;
  if (drawn.sources.empty()) {
    return SizeField::no_size;
  }
  if (inside_source) {
    return std::min(function.size_limit, function.start_size);
  }
  const bool is_fixed = function.kind == Kind::fixed;
  const double slope = 1.0 - 1.0 / function.growth_rate;
  double size = function.size_limit;
  const auto add = [&](const Facet& facet, double own_size) {
    const double start_size = is_fixed ? function.start_size : own_size;
    const auto distance = static_cast<double>(test::reference_distance(facet, p));
    size = std::min(size, start_size + slope * distance);
  };
  for (const FacetedSource& source : drawn.sources) {
    for (const Vec3& a : source.points) {
      add(Facet::point(a), 0.0);
    }
    for (const auto& [a, b] : source.segments) {
      add(Facet::segment(a, b), (b - a).norm());
    }
    for (const auto& [a, b, c] : source.triangles) {
      add(Facet::triangle(a, b, c), mean_of_sides({a, b, c}));
    }
    for (const auto& [a, b, c, d] : source.quads) {
      const bool by_sides = function.quad_size == QuadSize::sides;
      const double sides = mean_of_sides({a, b, c, d});
      add(Facet::triangle(a, b, c), by_sides ? sides : mean_of_sides({a, b, c}));
      add(Facet::triangle(a, c, d), by_sides ? sides : mean_of_sides({a, c, d}));
    }
  }
  return size;
}

bool is_below(const Entity& entity, Entities of, const Topology& topology, int only_dim = -1) {
  of.erase(std::remove_if(of.begin(), of.end(),
                          [=](const Entity& e) { return only_dim >= 0 && e.dim != only_dim; }),
           of.end());
  const std::set<Entity> closure = topology.closure(of);
  return closure.count(entity) > 0;
}

double expected_size(const std::vector<Drawn>& functions, const Entity& entity,
                     const Topology& topology, const Vec3& p) {
  double size = SizeField::no_size;
  for (const Drawn& drawn : functions) {
    const SizeFunction& function = drawn.function;
    if (is_below(entity, function.attachments, topology)) {
      const bool inside =
          function.kind == Kind::fixed && is_below(entity, function.sources, topology, 3);
      size = std::min(size, function_size(drawn, p, inside));
    }
  }
  return size;
}

TEST(SizeFieldProperties, AreTheSmallestOfTheFunctionsThatActOnTheEntity) {
  test::for_random_rounds(60, [](Random& random) {
    const Topology topology = row_of_cubes();
    const std::vector<Drawn> functions = random_functions(random, topology);
    SCOPED_TRACE(text_of(functions));
    const SizeField field = field_of(functions, Evaluator::grid);
    const double tolerance = field.options().tolerance;
    for (const Entity& entity : topology.entities()) {
      for (const Vec3& p : random_points(random, 10)) {
        const double expected = expected_size(functions, entity, topology, p);
        const double allowed = 1e-12 * expected + 4.0 * test::machine_epsilon * p.norm();
        if (expected == SizeField::no_size) {
          ASSERT_EQ(field.exact_size(entity, p), expected) << entity_name(entity);
          ASSERT_EQ(field.size(entity, p), expected) << entity_name(entity);
          continue;
        }
        ASSERT_NEAR(field.exact_size(entity, p), expected, allowed)
            << entity_name(entity) << ' ' << text_of(p);
        ASSERT_LE(field.size(entity, p), (1.0 + tolerance) * expected + allowed)
            << entity_name(entity) << ' ' << text_of(p);
      }
    }
  });
}

TEST(SizeFieldProperties, DoNotDependOnTheOrderOfFunctions) {
  test::for_random_rounds(60, [](Random& random) {
    const Topology topology = row_of_cubes();
    std::vector<Drawn> functions = random_functions(random, topology);
    SCOPED_TRACE(text_of(functions));
    const SizeField field = field_of(functions, Evaluator::exact);
    std::shuffle(functions.begin(), functions.end(), random);
    functions.push_back(functions[test::random_index(random, functions.size())]);
    const SizeField other = field_of(functions, Evaluator::exact);
    for (const Entity& entity : topology.entities()) {
      for (const Vec3& p : random_points(random, 10)) {
        ASSERT_EQ(other.exact_size(entity, p), field.exact_size(entity, p))
            << entity_name(entity) << ' ' << text_of(p);
      }
    }
  });
}

TEST(SizeFieldProperties, OneFunctionMoreNeverRaisesASize) {
  test::for_random_rounds(60, [](Random& random) {
    const Topology topology = row_of_cubes();
    const std::vector<Drawn> functions = random_functions(random, topology);
    const Drawn more = random_function(random, topology);
    SCOPED_TRACE(text_of(functions) + "and " + text_of({more}));
    SizeField field = field_of(functions, Evaluator::exact);
    const SizeField before = field_of(functions, Evaluator::exact);
    const std::size_t added = field.add(more.function);
    field.set_sources(added, more.sources);
    field.build();
    for (const Entity& entity : topology.entities()) {
      for (const Vec3& p : random_points(random, 5)) {
        ASSERT_LE(field.exact_size(entity, p), before.exact_size(entity, p))
            << entity_name(entity) << ' ' << text_of(p);
      }
    }
    field.remove(added);
    field.build();
    for (const Entity& entity : topology.entities()) {
      for (const Vec3& p : random_points(random, 5)) {
        ASSERT_EQ(field.exact_size(entity, p), before.exact_size(entity, p))
            << "removed, " << entity_name(entity) << ' ' << text_of(p);
      }
    }
  });
}

/// No group is left out of what is asked without an entity, but for what is inside a source volume,
/// which asks within its box only.
TEST(SizeFieldProperties, SmallestSizesAreThoseOfSomeEntityAndOfNoneSmaller) {
  test::for_random_rounds(60, [](Random& random) {
    const Topology topology = row_of_cubes();
    const std::vector<Drawn> functions = random_functions(random, topology);
    SCOPED_TRACE(text_of(functions));
    const SizeField field = field_of(functions, Evaluator::automatic);
    const std::vector<Vec3> points = random_points(random, 50);
    std::vector<double> sizes(points.size());
    std::vector<std::size_t> groups(points.size());
    field.smallest_sizes(points.data(), points.size(), sizes.data(), groups.data());
    for (std::size_t i = 0; i < points.size(); ++i) {
      double smallest = SizeField::no_size;
      for (const Entity& entity : topology.entities()) {
        smallest = std::min(smallest, field.size(entity, points[i]));
        const bool is_inside_a_source =
            std::any_of(functions.begin(), functions.end(), [&](const Drawn& drawn) {
              return drawn.function.kind == Kind::fixed &&
                     is_below(entity, drawn.function.sources, topology, 3);
            });
        ASSERT_TRUE(is_inside_a_source || sizes[i] <= field.size(entity, points[i]))
            << entity_name(entity) << ' ' << text_of(points[i]);
      }
      ASSERT_GE(sizes[i], smallest) << text_of(points[i]);
      if (sizes[i] < SizeField::no_size) {
        const Entity decides = field.groups()[groups[i]].entities.front();
        ASSERT_EQ(sizes[i], field.size(decides, points[i])) << text_of(points[i]);
      }
    }
  });
}

// ==== Files

using SizeFieldFileProperties = test::TestWithFolder;

TEST_F(SizeFieldFileProperties, AnswerTheSameToTheBit) {
  test::for_random_rounds(40, [&](Random& random) {
    const Topology topology = row_of_cubes();
    const std::vector<Drawn> functions = random_functions(random, topology);
    SCOPED_TRACE(text_of(functions));
    const SizeField field = field_of(
        functions, test::random_index(random, 3) == 0 ? Evaluator::exact : Evaluator::grid);
    const std::string path = this->path("field.mgf");
    save_field(field, path);
    const SizeField loaded = load_field(path);
    save_field(loaded, path + ".again");
    ASSERT_TRUE(test::bytes_of(path + ".again") == test::bytes_of(path));
    for (std::size_t i = 0; i < functions.size(); ++i) {
      EXPECT_EQ(size_function_text(loaded.functions()[i]),
                size_function_text(field.functions()[i]));
    }
    const std::vector<Vec3> points = random_points(random, 20);
    std::vector<double> smallest(points.size());
    std::vector<double> loaded_smallest(points.size());
    field.smallest_sizes(points.data(), points.size(), smallest.data());
    loaded.smallest_sizes(points.data(), points.size(), loaded_smallest.data());
    ASSERT_EQ(loaded_smallest, smallest);
    for (const Entity& entity : topology.entities()) {
      for (const Vec3& p : points) {
        ASSERT_EQ(loaded.size(entity, p), field.size(entity, p))
            << entity_name(entity) << ' ' << text_of(p);
        ASSERT_EQ(loaded.exact_size(entity, p), field.exact_size(entity, p))
            << entity_name(entity) << ' ' << text_of(p);
      }
    }
  });
}

}  // namespace
}  // namespace meshgrow
