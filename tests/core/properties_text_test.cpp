// Numbers and size functions survive being written and read, whatever they are.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "error.h"
#include "number_text.h"
#include "property_rounds.h"
#include "random_models.h"
#include "size_function_text.h"

namespace meshgrow {
namespace {

using test::Random;
using test::random_index;

using Entities = std::vector<Entity>;

/// Any double but NaN: every sign, exponent and digit.
double random_number(Random& random) {
  for (;;) {
    const std::uint64_t bits = random();
    double number = 0.0;
    std::memcpy(&number, &bits, sizeof number);
    if (!std::isnan(number)) {
      return number;
    }
  }
}

/// Between the two, with all its digits or few.
double random_number(Random& random, double low, double high) {
  const double number = test::log_uniform(random, low, high);
  const double short_number =
      std::strtod(shortest(number, 1 + static_cast<int>(random_index(random, 4))).c_str(), nullptr);
  return random_index(random, 3) == 0 && short_number >= low && short_number <= high ? short_number
                                                                                     : number;
}

TEST(NumberTextProperties, ExactTextReadsAsTheSameNumber) {
  test::for_random_rounds(20000, [](Random& random) {
    const double number = random_number(random);
    const std::string text = exact_text(number);
    const double read = std::strtod(text.c_str(), nullptr);
    EXPECT_EQ(read, number) << text;
    EXPECT_EQ(std::signbit(read), std::signbit(number)) << text;
  });
}

TEST(NumberTextProperties, ShortestTextIsNearAndShort) {
  test::for_random_rounds(5000, [](Random& random) {
    const double number = random_number(random, 1e-300, 1e300);
    const std::string text = shortest(number);
    // Half a unit of the sixth digit.
    EXPECT_NEAR(std::strtod(text.c_str(), nullptr), number, 5.1e-6 * number) << text;
    EXPECT_LE(text.size(), 12u) << text;
  });
}

TEST(NumberTextProperties, GroupedDigitsAreThoseOfTheNumber) {
  test::for_random_rounds(5000, [](Random& random) {
    const std::size_t number = random() >> random_index(random, 64);
    std::string text = grouped_digits(number);
    for (std::size_t i = 0; i < text.size(); ++i) {
      EXPECT_EQ(text[text.size() - 1 - i] == ',', i % 4 == 3) << text;
    }
    text.erase(std::remove(text.begin(), text.end(), ','), text.end());
    EXPECT_EQ(text, std::to_string(number));
  });
}

// ==== Size functions

/// Entities of every dimension, with tags from 1 to the largest there are.
Topology random_topology(Random& random) {
  Topology topology;
  for (int dim = 0; dim <= 3; ++dim) {
    std::set<int> tags = {1, std::numeric_limits<int>::max()};
    for (std::size_t i = random_index(random, 8); i > 0; --i) {
      tags.insert(static_cast<int>(test::log_uniform(random, 1.0, 2e9)));
    }
    const Entities below = dim == 0 ? Entities() : topology.entities(dim - 1);
    for (const int tag : tags) {
      topology.add_entity({dim, tag}, below);
    }
  }
  return topology;
}

std::string random_name(Random& random) {
  static const std::vector<std::string> pieces = {
      "a", "B", "7", " ", "-", "_", "{", "}", ",", "\\", "/", "ü", "線", "name", "limit", "%", "'"};
  std::string name = "x";
  for (std::size_t i = random_index(random, 8); i > 0; --i) {
    name += pieces[random_index(random, pieces.size())];
  }
  return name;
}

SizeFunction random_function(Random& random, const Topology& topology) {
  const auto some = [&](int lowest) {
    Entities all = topology.entities();
    all.erase(std::remove_if(all.begin(), all.end(),
                             [lowest](const Entity& entity) { return entity.dim < lowest; }),
              all.end());
    std::shuffle(all.begin(), all.end(), random);
    all.resize(1 + random_index(random, std::min<std::size_t>(all.size(), 5)));
    return all;
  };
  for (;;) {
    SizeFunction function;
    function.kind = static_cast<Kind>(random_index(random, 4));
    function.sources = some(function.kind == Kind::fixed ? 0 : 1);
    function.attachments = some(1);
    function.growth_rate = 1.0 + random_number(random, 1e-15, 1e3);
    function.size_limit = random_number(random, 1e-300, 1e22);
    function.name = random_index(random, 2) == 0 ? "" : random_name(random);
    if (function.kind == Kind::mesh) {
      function.quad_size = static_cast<QuadSize>(random_index(random, 2));
    } else if (function.kind == Kind::fixed) {
      function.start_size = random_number(random, 1e-300, 1e22);
    } else if (function.kind == Kind::curvature) {
      function.angle = random_number(random, 0.1, 180.0);
    } else {
      function.cells_per_gap = random_number(random, 0.1, 1000.0);
      function.between = static_cast<GapsBetween>(random_index(random, 4));
    }
    if (function.kind == Kind::curvature || function.kind == Kind::proximity) {
      function.min_size =
          random_index(random, 2) == 0 ? 0.0 : random_number(random, 1e-320, function.size_limit);
    }
    try {
      validate(function, "", topology);
      return function;
    } catch (const Error&) {
      // Entities that do not go together: draw again.
    }
  }
}

Entities sorted(const Entities& entities) {
  const std::set<Entity> all(entities.begin(), entities.end());
  return {all.begin(), all.end()};
}

auto all_of(const SizeFunction& f) {
  return std::make_tuple(f.kind, f.name, sorted(f.sources), sorted(f.attachments), f.growth_rate,
                         f.size_limit, f.start_size, f.quad_size, f.angle, f.cells_per_gap,
                         f.between, f.min_size);
}

TEST(SizeFunctionTextProperties, WhatIsWrittenReadsTheSameToTheBit) {
  test::for_random_rounds(2000, [](Random& random) {
    const Topology topology = random_topology(random);
    const SizeFunction function = random_function(random, topology);
    const std::string text = size_function_text(function);
    SCOPED_TRACE(text);
    SizeFunction read;
    ASSERT_NO_THROW(read = parse_size_function(text, topology));
    EXPECT_TRUE(all_of(read) == all_of(function)) << size_function_text(read);
    EXPECT_EQ(size_function_text(read), text);
  });
}

}  // namespace
}  // namespace meshgrow
