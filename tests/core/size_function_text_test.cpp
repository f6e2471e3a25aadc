#include "size_function_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <clocale>
#include <random>
#include <string>
#include <vector>

#include "error.h"

namespace meshgrow {
namespace {

using Entities = std::vector<Entity>;

Topology model() {
  Topology topology;
  for (const int tag : {1, 2, 3}) {
    topology.add_entity({0, tag}, {});
  }
  for (const int tag : {1, 4, 5, 6, 9}) {
    topology.add_entity({1, tag}, {});
  }
  for (const int tag : {1, 2, 7, 8, 9}) {
    topology.add_entity({2, tag}, {});
  }
  for (const int tag : {1, 2}) {
    topology.add_entity({3, tag}, {});
  }
  topology.add_physical_group({1, 3, "inlet", {{1, 4}}});
  topology.add_physical_group({2, 3, "inlet", {{2, 7}, {2, 8}}});
  topology.add_physical_group({2, 12, "outer wall", {{2, 9}}});
  topology.add_physical_group({2, 15, "", {{2, 1}}});
  topology.add_physical_group({2, 16, "top, bottom {1}", {{2, 2}}});
  topology.add_physical_group({3, 40, "air", {{3, 2}}});
  return topology;
}

SizeFunction parse(const std::string& text) { return parse_size_function(text, model()); }

/// The sources of a mesh size function on this selection.
Entities sources(const std::string& selection) {
  return parse("mesh source " + selection + " attach Volume{2} growth 1.2 limit 2").sources;
}

std::string message_of(const std::string& text) {
  try {
    parse(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Expects an error at the place marked by ^ that tells what was expected there.
void expect_error_at(const std::string& marked_text, const std::string& expected) {
  const std::size_t mark = marked_text.find('^');
  ASSERT_NE(mark, std::string::npos);
  const std::string text = marked_text.substr(0, mark) + marked_text.substr(mark + 1);
  const std::string message = message_of(text);
  ASSERT_FALSE(message.empty()) << "no error for: " << text;
  // The text itself stands in the message, too; what is looked for stands after it.
  const std::size_t quoted = message.find(text);
  ASSERT_NE(quoted, std::string::npos) << message;
  const std::string rest = message.substr(quoted + text.size());
  const std::string position = "position " + std::to_string(mark + 1);
  const std::size_t found = rest.find(position);
  ASSERT_NE(found, std::string::npos) << "not at " << position << ": " << message;
  const char after = rest[found + position.size()];
  EXPECT_FALSE(after >= '0' && after <= '9') << message;
  EXPECT_NE(rest.find(expected), std::string::npos) << "'" << expected << "' in: " << message;
}

/// Expects an error that names something which is not in the model.
void expect_unknown(const std::string& text, const std::string& name) {
  const std::string message = message_of(text);
  ASSERT_FALSE(message.empty()) << "no error for: " << text;
  const std::string rest = message.substr(message.find(text) + text.size());
  EXPECT_NE(rest.find(name), std::string::npos) << "'" << name << "' in: " << message;
}

// ==== What is understood

TEST(SizeFunctionText, CurvatureExampleOfTheHeader) {
  const SizeFunction function =
      parse("curvature source Surface{:} attach Volume{1} angle 12.5 growth 1.2 limit 2 min 0.01");
  EXPECT_EQ(function.kind, Kind::curvature);
  EXPECT_EQ(function.sources, (Entities{{2, 1}, {2, 2}, {2, 7}, {2, 8}, {2, 9}}));
  EXPECT_EQ(function.attachments, (Entities{{3, 1}}));
  EXPECT_EQ(function.angle, 12.5);
  EXPECT_EQ(function.growth_rate, 1.2);
  EXPECT_EQ(function.size_limit, 2.0);
  EXPECT_EQ(function.min_size, 0.01);
}

TEST(SizeFunctionText, ProximityExampleOfTheHeader) {
  const SizeFunction function = parse(
      "proximity source Volume{1} attach Volume{1} cells 2.5 between both growth 1.2 limit 2");
  EXPECT_EQ(function.kind, Kind::proximity);
  EXPECT_EQ(function.sources, (Entities{{3, 1}}));
  EXPECT_EQ(function.cells_per_gap, 2.5);
  EXPECT_EQ(function.between, GapsBetween::both);
  EXPECT_EQ(function.min_size, 0.0);
}

TEST(SizeFunctionText, WhatMayBeLeftOutHasDefaults) {
  const std::string rest = " source Volume{1} attach Volume{1} growth 1.2 limit 2";
  EXPECT_EQ(parse("curvature" + rest).angle, 18.0);
  EXPECT_EQ(parse("curvature" + rest).min_size, 0.0);
  EXPECT_EQ(parse("proximity" + rest).cells_per_gap, 3.0);
  EXPECT_EQ(parse("proximity" + rest).between, GapsBetween::automatic);
}

TEST(SizeFunctionText, GapsBetweenFacesOrEdges) {
  const std::string text =
      "proximity source Volume{1} attach Volume{1} growth 1.2 limit 2 between ";
  EXPECT_EQ(parse(text + "faces").between, GapsBetween::faces);
  EXPECT_EQ(parse(text + "edges").between, GapsBetween::edges);
  EXPECT_EQ(parse(text + "both").between, GapsBetween::both);
}

// ==== What is written

/// Numbers that need all their digits, entities in several dimensions.
SizeFunction random_function(std::mt19937_64& random, Kind kind) {
  const auto number = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto some = [&random](Entities entities) {
    std::shuffle(entities.begin(), entities.end(), random);
    entities.resize(1 + random() % entities.size());
    std::sort(entities.begin(), entities.end());
    return entities;
  };
  SizeFunction function;
  function.kind = kind;
  function.sources = some({{1, 4}, {1, 5}, {2, 1}, {2, 7}, {2, 8}});
  function.attachments = some({{1, 1}, {2, 9}, {3, 1}, {3, 2}});
  function.growth_rate = number(1.0, 2.0);
  function.size_limit = number(1e-9, 1e9);
  if (kind == Kind::mesh) {
    function.quad_size = random() % 2 == 0 ? QuadSize::sides : QuadSize::triangles;
  } else if (kind == Kind::fixed) {
    function.start_size = number(1e-9, 1.0);
  } else if (kind == Kind::curvature) {
    function.angle = number(1.0, 90.0);
  } else {
    function.cells_per_gap = number(0.5, 20.0);
    function.between = static_cast<GapsBetween>(random() % 4);
  }
  if (kind == Kind::curvature || kind == Kind::proximity) {
    function.min_size = random() % 2 == 0 ? 0.0 : number(1e-12, 1e-9);
  }
  return function;
}

TEST(SizeFunctionText, WhatIsWrittenReadsTheSame) {
  constexpr unsigned seed = 11;
  std::mt19937_64 random(seed);
  for (const Kind kind : {Kind::mesh, Kind::fixed, Kind::curvature, Kind::proximity}) {
    for (int i = 0; i < 200; ++i) {
      const SizeFunction function = random_function(random, kind);
      const std::string text = size_function_text(function);
      const SizeFunction read = parse(text);
      ASSERT_EQ(read.kind, function.kind) << text << ", seed " << seed;
      ASSERT_EQ(read.sources, function.sources) << text;
      ASSERT_EQ(read.attachments, function.attachments) << text;
      ASSERT_EQ(read.growth_rate, function.growth_rate) << text;
      ASSERT_EQ(read.size_limit, function.size_limit) << text;
      ASSERT_EQ(read.start_size, function.start_size) << text;
      ASSERT_EQ(read.quad_size, function.quad_size) << text;
      ASSERT_EQ(read.angle, function.angle) << text;
      ASSERT_EQ(read.cells_per_gap, function.cells_per_gap) << text;
      ASSERT_EQ(read.between, function.between) << text;
      ASSERT_EQ(read.min_size, function.min_size) << text;
      ASSERT_EQ(size_function_text(read), text);
    }
  }
}

TEST(SizeFunctionText, EntitiesInAnyOrderAreWrittenAsTheyAreRead) {
  SizeFunction function = parse("mesh source Surface{7} attach Volume{2} growth 1.2 limit 2");
  function.sources = {{2, 8}, {1, 4}, {2, 7}, {2, 8}};
  const std::string text = size_function_text(function);
  EXPECT_EQ(text, "mesh source Curve{4}, Surface{7,8} attach Volume{2} growth 1.2 limit 2");
  EXPECT_EQ(size_function_text(parse(text)), text);
}

TEST(SizeFunctionText, IsWrittenAsAPersonWould) {
  EXPECT_EQ(size_function_text(parse("fixed size 0.1 source Surface{8,7},Curve{4} limit 2 "
                                     "attach Volume{2} growth 1.2")),
            "fixed source Curve{4}, Surface{7,8} attach Volume{2} size 0.1 growth 1.2 limit 2");
  EXPECT_EQ(size_function_text(parse("proximity source Volume{1} attach Volume{1} cells 3 "
                                     "growth 1.2 limit 2 min 0.25 between edges")),
            "proximity source Volume{1} attach Volume{1} cells 3 between edges growth 1.2 limit 2 "
            "min 0.25");
}

TEST(SizeFunctionText, MeshExampleOfTheHeader) {
  const SizeFunction function =
      parse("mesh  source Surface{7}   attach Volume{2}                 growth 1.2 limit 2");
  EXPECT_EQ(function.kind, Kind::mesh);
  EXPECT_EQ(function.sources, (Entities{{2, 7}}));
  EXPECT_EQ(function.attachments, (Entities{{3, 2}}));
  EXPECT_EQ(function.growth_rate, 1.2);
  EXPECT_EQ(function.size_limit, 2.0);
  EXPECT_EQ(function.quad_size, QuadSize::triangles);
}

TEST(SizeFunctionText, FixedExampleOfTheHeader) {
  const SizeFunction function = parse(
      "fixed source Curve{1,4:6} attach Physical Surface{\"inlet\"} size 0.1 growth 1.2 limit 2");
  EXPECT_EQ(function.kind, Kind::fixed);
  EXPECT_EQ(function.sources, (Entities{{1, 1}, {1, 4}, {1, 5}, {1, 6}}));
  EXPECT_EQ(function.attachments, (Entities{{2, 7}, {2, 8}}));
  EXPECT_EQ(function.start_size, 0.1);
  EXPECT_EQ(function.growth_rate, 1.2);
  EXPECT_EQ(function.size_limit, 2.0);
}

TEST(SizeFunctionText, PartsInAnyOrder) {
  const SizeFunction function =
      parse("fixed limit 2 size 0.1 attach Volume{2} growth 1.5 source Point{3}");
  EXPECT_EQ(function.sources, (Entities{{0, 3}}));
  EXPECT_EQ(function.attachments, (Entities{{3, 2}}));
  EXPECT_EQ(function.start_size, 0.1);
  EXPECT_EQ(function.growth_rate, 1.5);
  EXPECT_EQ(function.size_limit, 2.0);
}

TEST(SizeFunctionText, SpaceWhereverItIsHarmless) {
  const SizeFunction function = parse(
      "  \tfixed source  Curve { 1 , 4 : 6 } ,Point{3}attach Physical  Surface { \"inlet\" } "
      "size 0.1 growth 1.2 limit 2 \n");
  EXPECT_EQ(function.sources, (Entities{{0, 3}, {1, 1}, {1, 4}, {1, 5}, {1, 6}}));
  EXPECT_EQ(function.attachments, (Entities{{2, 7}, {2, 8}}));
}

TEST(SizeFunctionText, EveryDimension) {
  EXPECT_EQ(sources("Point{1}"), (Entities{{0, 1}}));
  EXPECT_EQ(sources("Curve{9}"), (Entities{{1, 9}}));
  EXPECT_EQ(sources("Line{9}"), (Entities{{1, 9}}));
  EXPECT_EQ(sources("Surface{9}"), (Entities{{2, 9}}));
  EXPECT_EQ(sources("Volume{1}"), (Entities{{3, 1}}));
}

TEST(SizeFunctionText, TagsAndRanges) {
  EXPECT_EQ(sources("Surface{8, 1, 9}"), (Entities{{2, 1}, {2, 8}, {2, 9}}));
  EXPECT_EQ(sources("Surface{7:9}"), (Entities{{2, 7}, {2, 8}, {2, 9}}));
  EXPECT_EQ(sources("Surface{2:2}"), (Entities{{2, 2}}));
  // Of a range, the entities that exist.
  EXPECT_EQ(sources("Surface{2:8}"), (Entities{{2, 2}, {2, 7}, {2, 8}}));
  EXPECT_EQ(sources("Curve{1, 4:5, 9}"), (Entities{{1, 1}, {1, 4}, {1, 5}, {1, 9}}));
  EXPECT_EQ(sources("Curve{1,1,1}"), (Entities{{1, 1}}));
  EXPECT_EQ(sources("Curve{4:6, 5}"), (Entities{{1, 4}, {1, 5}, {1, 6}}));
}

TEST(SizeFunctionText, ColonForAll) {
  EXPECT_EQ(sources("Surface{:}"), (Entities{{2, 1}, {2, 2}, {2, 7}, {2, 8}, {2, 9}}));
  EXPECT_EQ(sources("Surface{ : }"), (Entities{{2, 1}, {2, 2}, {2, 7}, {2, 8}, {2, 9}}));
  EXPECT_EQ(sources("Point{:}"), (Entities{{0, 1}, {0, 2}, {0, 3}}));
  EXPECT_EQ(sources("Physical Surface{:}"), (Entities{{2, 1}, {2, 2}, {2, 7}, {2, 8}, {2, 9}}));
  EXPECT_EQ(sources("Physical Curve{:}"), (Entities{{1, 4}}));
}

TEST(SizeFunctionText, PhysicalGroupsByTag) {
  EXPECT_EQ(sources("Physical Surface{3}"), (Entities{{2, 7}, {2, 8}}));
  EXPECT_EQ(sources("Physical Curve{3}"), (Entities{{1, 4}}));
  EXPECT_EQ(sources("Physical Surface{12, 15}"), (Entities{{2, 1}, {2, 9}}));
}

TEST(SizeFunctionText, PhysicalGroupsByName) {
  EXPECT_EQ(sources("Physical Surface{\"inlet\"}"), (Entities{{2, 7}, {2, 8}}));
  EXPECT_EQ(sources("Physical Surface{inlet}"), (Entities{{2, 7}, {2, 8}}));
  EXPECT_EQ(sources("Physical Surface{ inlet }"), (Entities{{2, 7}, {2, 8}}));
  EXPECT_EQ(sources("Physical Curve{inlet}"), (Entities{{1, 4}}));
  EXPECT_EQ(sources("Physical Line{\"inlet\"}"), (Entities{{1, 4}}));
  EXPECT_EQ(sources("Physical Surface{outer wall}"), (Entities{{2, 9}}));
  EXPECT_EQ(sources("Physical Surface{\"outer wall\"}"), (Entities{{2, 9}}));
  EXPECT_EQ(sources("Physical Surface{\"top, bottom {1}\"}"), (Entities{{2, 2}}));
}

TEST(SizeFunctionText, PhysicalNamesAndTagsTogether) {
  EXPECT_EQ(sources("Physical Surface{inlet, 15, \"outer wall\"}"),
            (Entities{{2, 1}, {2, 7}, {2, 8}, {2, 9}}));
}

TEST(SizeFunctionText, SeveralSelections) {
  const SizeFunction function = parse(
      "mesh source Surface{7}, Curve{4:5}, Physical Surface{15} "
      "attach Volume{1},Physical Volume{air},Surface{2} growth 1.2 limit 2");
  EXPECT_EQ(function.sources, (Entities{{1, 4}, {1, 5}, {2, 1}, {2, 7}}));
  EXPECT_EQ(function.attachments, (Entities{{2, 2}, {3, 1}, {3, 2}}));
}

TEST(SizeFunctionText, RuleForQuads) {
  const std::string rest = " source Surface{7} attach Volume{2} growth 1.2 limit 2 ";
  EXPECT_EQ(parse("mesh" + rest + "quad_size sides").quad_size, QuadSize::sides);
  EXPECT_EQ(parse("mesh" + rest + "quad_size triangles").quad_size, QuadSize::triangles);
}

TEST(SizeFunctionText, NumbersInEveryNotation) {
  const auto limit = [](const std::string& number) {
    return parse("mesh source Curve{1} attach Volume{2} growth 1.2 limit " + number).size_limit;
  };
  EXPECT_EQ(limit("2"), 2.0);
  EXPECT_EQ(limit("2."), 2.0);
  EXPECT_EQ(limit(".5"), 0.5);
  EXPECT_EQ(limit("+2.5"), 2.5);
  EXPECT_EQ(limit("1e-3"), 1e-3);
  EXPECT_EQ(limit("2.5E+2"), 250.0);
}

TEST(SizeFunctionText, DecimalPointInEveryLocale) {
  // A program in another language may have set one that reads decimal commas.
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  bool has_comma = false;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8", "German"}) {
    has_comma = has_comma || (std::setlocale(LC_NUMERIC, name) != nullptr &&
                              *std::localeconv()->decimal_point == ',');
  }
  if (!has_comma) {
    std::setlocale(LC_NUMERIC, before.c_str());
    GTEST_SKIP() << "No locale with decimal commas is installed.";
  }
  const std::string text = "mesh source Curve{1} attach Volume{2} growth 1.2 limit 2.5";
  const std::string message = message_of(text);
  const double growth_rate = message.empty() ? parse(text).growth_rate : 0.0;
  std::setlocale(LC_NUMERIC, before.c_str());
  EXPECT_EQ(message, "");
  EXPECT_EQ(growth_rate, 1.2);
}

// ==== Mistakes

TEST(SizeFunctionText, MistakesInTheKind) {
  const std::string kinds = "'mesh', 'fixed', 'curvature' or 'proximity'";
  expect_error_at("^", kinds);
  expect_error_at("   ^", kinds);
  expect_error_at("^mash source Surface{7} attach Volume{2} growth 1.2 limit 2", kinds);
  expect_error_at("  ^Mesh source Surface{7} attach Volume{2} growth 1.2 limit 2", kinds);
  expect_error_at("^12", kinds);
}

TEST(SizeFunctionText, MistakesInTheParts) {
  expect_error_at("mesh ^sources Surface{7} attach Volume{2} growth 1.2 limit 2", "'source'");
  expect_error_at("mesh source Surface{7} ^Volume{2} growth 1.2 limit 2", "'attach'");
  expect_error_at("mesh source Surface{7} attach Volume{2} growth 1.2 limit 2 ^size 0.1",
                  "'limit'");
  expect_error_at(
      "fixed source Curve{1} attach Volume{2} size 1 growth 1.2 limit 2 ^quad_size sides",
      "'size'");
  expect_error_at("mesh source Surface{7} attach Volume{2} growth 1.2 limit 2 ^3", "'growth'");
  expect_error_at("mesh source Surface{7} attach Volume{2} growth 1.2 limit 2^;", "'growth'");
  expect_error_at("mesh source Surface{7} attach Volume{2} growth 1.2 limit 2^mm", "'growth'");
}

TEST(SizeFunctionText, MissingParts) {
  expect_error_at("mesh attach Volume{2} growth 1.2 limit 2^", "'source'");
  expect_error_at("mesh source Surface{7} growth 1.2 limit 2^", "'attach'");
  expect_error_at("mesh source Surface{7} attach Volume{2} limit 2^", "'growth'");
  expect_error_at("mesh source Surface{7} attach Volume{2} growth 1.2^", "'limit'");
  expect_error_at("fixed source Surface{7} attach Volume{2} growth 1.2 limit 2^", "'size'");
}

TEST(SizeFunctionText, MistakesInNumbers) {
  expect_error_at("mesh source Surface{7} attach Volume{2} growth ^fast limit 2", "growth rate");
  expect_error_at("mesh source Surface{7} attach Volume{2} growth 1.2 limit ^", "limit");
  expect_error_at("mesh source Surface{7} attach Volume{2} growth 1.2 limit   ^,5", "limit");
  expect_error_at("fixed source Surface{7} attach Volume{2} size ^{1} growth 1.2 limit 2", "size");
}

TEST(SizeFunctionText, MistakesInTheRuleForQuads) {
  expect_error_at("mesh source Surface{7} attach Volume{2} growth 1.2 limit 2 quad_size ^diagonal",
                  "'triangles' or 'sides'");
  expect_error_at("mesh source Surface{7} attach Volume{2} growth 1.2 limit 2 quad_size^",
                  "'triangles' or 'sides'");
}

TEST(SizeFunctionText, MistakesInWhatOnlySomeKindsHave) {
  const std::string rest = " source Surface{7} attach Volume{2} growth 1.2 limit 2 ";
  expect_error_at("curvature" + rest + "angle ^wide", "angle in degrees");
  expect_error_at("curvature" + rest + "min ^", "smallest size");
  expect_error_at("proximity" + rest + "cells ^three", "number of cells");
  expect_error_at("proximity" + rest + "between ^walls", "'faces', 'edges' or 'both'");
  const std::string curvature_words =
      "'source', 'attach', 'angle', 'growth', 'limit', 'min' or 'name'";
  expect_error_at("curvature" + rest + "^cells 3", curvature_words);
  expect_error_at("curvature" + rest + "^size 3", curvature_words);
  expect_error_at("curvature" + rest + "^quad_size sides", curvature_words);
  expect_error_at("proximity" + rest + "^angle 3",
                  "'source', 'attach', 'cells', 'between', 'growth', 'limit', 'min' or 'name'");
  expect_error_at("fixed" + rest + "^min 3", "'size', 'growth', 'limit' or 'name'");
  expect_error_at("mesh" + rest + "^angle 3", "'growth', 'limit', 'quad_size' or 'name'");
}

TEST(SizeFunctionText, NamesAreKept) {
  const Topology topology = model();
  const std::string rest = "fixed source Surface{7} attach Volume{2} size 0.1 growth 1.2 limit 2";
  EXPECT_EQ(parse_size_function(rest, topology).name, "");
  EXPECT_EQ(parse_size_function(rest + " name inner-1", topology).name, "inner-1");
  EXPECT_EQ(parse_size_function("fixed name \"in ner\"" + rest.substr(5), topology).name, "in ner");
  SizeFunction function = parse_size_function(rest + " name \"in ner\"", topology);
  EXPECT_EQ(size_function_text(function), rest + " name \"in ner\"");
  function.name = "12";
  EXPECT_EQ(size_function_text(function), rest);
  const std::string wanted = "a name that is not a number and has no quotes";
  expect_error_at(rest + " name ^12", wanted);
  expect_error_at(rest + " name ^\"\"", wanted);
  expect_error_at(rest + " name ^\"a", wanted);
  expect_error_at(rest + " name ^a\"b", wanted);
  expect_error_at(rest + " name^", wanted);
}

TEST(SizeFunctionText, MistakesInSelections) {
  const std::string rest = " attach Volume{2} growth 1.2 limit 2";
  const std::string dimensions = "Point, Curve, Surface or Volume";
  expect_error_at("mesh source ^Face{7}" + rest, dimensions);
  expect_error_at("mesh source ^surface{7}" + rest, dimensions);
  expect_error_at("mesh source ^{7}" + rest, dimensions);
  expect_error_at("mesh source ^", dimensions);
  expect_error_at("mesh source Physical ^Group{7}" + rest, dimensions);
  expect_error_at("mesh source Surface{7}, ^attach Volume{2} growth 1.2 limit 2", dimensions);
  expect_error_at("mesh source Surface ^7" + rest, "'{'");
  expect_error_at("mesh source Surface^", "'{'");
  expect_error_at("mesh source Physical Surface ^inlet" + rest, "'{'");
  expect_error_at("mesh source Surface{7 ^attach Volume{2} growth 1.2 limit 2", "','");
  expect_error_at("mesh source Surface{7 ^8}" + rest, "','");
  expect_error_at("mesh source Surface{:^8}" + rest, "'}'");
  expect_error_at("mesh source Surface{1:^", "a tag");
}

TEST(SizeFunctionText, MistakesInTags) {
  const std::string rest = " attach Volume{2} growth 1.2 limit 2";
  expect_error_at("mesh source Surface{^}" + rest, "a tag");
  expect_error_at("mesh source Surface{7,^}" + rest, "a tag");
  expect_error_at("mesh source Surface{ ^inlet}" + rest, "a tag");
  expect_error_at("mesh source Surface{^\"inlet\"}" + rest, "a tag");
  expect_error_at("mesh source Surface{^1.5}" + rest, "whole number");
  expect_error_at("mesh source Surface{7, ^2.5}" + rest, "whole number");
  expect_error_at("mesh source Surface{^1e99}" + rest, "whole number");
  expect_error_at("mesh source Surface{^nan}" + rest, "whole number");
  expect_error_at("mesh source Surface{1:^2.5}" + rest, "whole number");
}

TEST(SizeFunctionText, PositionOfATagAfterARangesColonAndSpace) {
  expect_error_at("mesh source Surface{1: ^2.5} attach Volume{2} growth 1.2 limit 2",
                  "whole number");
}

TEST(SizeFunctionText, MistakesInPhysicalGroups) {
  const std::string rest = " attach Volume{2} growth 1.2 limit 2";
  expect_error_at("mesh source Physical Surface{^}" + rest, "physical group");
  expect_error_at("mesh source Physical Surface{inlet,^}" + rest, "physical group");
  expect_error_at("mesh source Physical Surface{\"inlet\" ^15}" + rest, "','");
  expect_error_at("mesh source Physical Surface{\"inlet} attach^", "'\"'");
  expect_error_at("mesh source Physical Surface{\"inlet\" ^attach Volume{2} growth 1.2 limit 2",
                  "','");
}

TEST(SizeFunctionText, UnknownEntityIsNamed) {
  expect_unknown("mesh source Surface{7, 33} attach Volume{2} growth 1.2 limit 2", "Surface 33");
  expect_unknown("mesh source Surface{7} attach Volume{17} growth 1.2 limit 2", "Volume 17");
  expect_unknown("mesh source Curve{-4} attach Volume{2} growth 1.2 limit 2", "Curve -4");
}

TEST(SizeFunctionText, RangeWithoutEntitiesIsNamed) {
  expect_unknown("mesh source Surface{30:40} attach Volume{2} growth 1.2 limit 2", "30 to 40");
}

TEST(SizeFunctionText, UnknownPhysicalGroupIsNamed) {
  const std::string rest = " attach Volume{2} growth 1.2 limit 2";
  expect_unknown("mesh source Physical Surface{outlet}" + rest, "Physical Surface \"outlet\"");
  expect_unknown("mesh source Physical Surface{inlet, \"out let\"}" + rest,
                 "Physical Surface \"out let\"");
  expect_unknown("mesh source Physical Surface{99}" + rest, "Physical Surface \"99\"");
  // The name belongs to a group of another dimension.
  expect_unknown("mesh source Physical Curve{outer wall}" + rest, "Physical Curve \"outer wall\"");
  expect_unknown("mesh source Physical Surface{Inlet}" + rest, "Physical Surface \"Inlet\"");
}

TEST(SizeFunctionText, SelectionOfNothingIsAnError) {
  EXPECT_NE(message_of("mesh source Surface{30:40} attach Volume{2} growth 1.2 limit 2"), "");
  EXPECT_NE(message_of("mesh source Surface{7} attach Volume{3:9} growth 1.2 limit 2"), "");
}

TEST(SizeFunctionText, ZeroIsNoLimitAndNoSize) {
  EXPECT_NE(message_of("mesh source Surface{7} attach Volume{2} growth 1.2 limit 0"), "");
  EXPECT_NE(message_of("fixed source Surface{7} attach Volume{2} size 0 growth 1.2 limit 2"), "");
}

}  // namespace
}  // namespace meshgrow
