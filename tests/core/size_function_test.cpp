#include "size_function.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "error.h"

namespace meshgrow {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

Topology model() {
  Topology topology;
  for (int dim = 0; dim <= 3; ++dim) {
    for (int tag = 1; tag <= 4; ++tag) {
      topology.add_entity({dim, tag}, {});
    }
  }
  return topology;
}

SizeFunction mesh_function() {
  SizeFunction function;
  function.kind = Kind::mesh;
  function.sources = {{2, 1}, {1, 2}};
  function.attachments = {{3, 1}, {2, 3}, {1, 4}};
  function.growth_rate = 1.2;
  function.size_limit = 2.0;
  return function;
}

SizeFunction fixed_function() {
  SizeFunction function = mesh_function();
  function.kind = Kind::fixed;
  function.sources = {{0, 1}, {1, 2}, {2, 1}, {3, 4}};
  function.start_size = 0.1;
  return function;
}

/// The message of the error, which begins with the name given and is one sentence.
std::string message_of(const SizeFunction& function) {
  try {
    validate(function, "Function under test", model());
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find("Function under test"), 0u) << message;
    EXPECT_EQ(message.back(), '.') << message;
    EXPECT_EQ(message.find(". "), std::string::npos) << "more than one sentence: " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  return "";
}

/// Changes a good function of either kind and expects an error with all of the texts.
void expect_error(SizeFunction function, const std::function<void(SizeFunction&)>& spoil,
                  const std::vector<std::string>& texts) {
  ASSERT_EQ(message_of(function), "");
  spoil(function);
  const std::string message = message_of(function);
  ASSERT_FALSE(message.empty()) << "no error that names " << texts.front();
  for (const std::string& text : texts) {
    EXPECT_NE(message.find(text), std::string::npos) << "'" << text << "' in: " << message;
  }
}

TEST(SizeFunction, KindsHaveNames) {
  EXPECT_EQ(kind_name(Kind::mesh), "mesh");
  EXPECT_EQ(kind_name(Kind::fixed), "fixed");
  EXPECT_EQ(kind_name(Kind::curvature), "curvature");
  EXPECT_EQ(kind_name(Kind::proximity), "proximity");
}

TEST(SizeFunction, GoodOnesPass) {
  EXPECT_EQ(message_of(mesh_function()), "");
  EXPECT_EQ(message_of(fixed_function()), "");
  for (const double growth_rate : {1.0, 1.0 + 1e-12, 5.0}) {
    SizeFunction function = mesh_function();
    function.growth_rate = growth_rate;
    EXPECT_EQ(message_of(function), "");
  }
  for (const double size : {1e-12, 1e12}) {
    SizeFunction function = fixed_function();
    function.size_limit = function.start_size = size;
    EXPECT_EQ(message_of(function), "");
  }
}

TEST(SizeFunction, MeshNeedsNoStartSize) {
  SizeFunction function = mesh_function();
  function.start_size = not_a_number;
  EXPECT_EQ(message_of(function), "");
}

TEST(SizeFunction, FixedMayActOnItsOwnSource) {
  SizeFunction function = fixed_function();
  function.sources = function.attachments = {{3, 1}, {2, 1}, {1, 1}};
  EXPECT_EQ(message_of(function), "");
}

TEST(SizeFunction, StartSizeMayExceedTheLimit) {
  SizeFunction function = fixed_function();
  function.start_size = 3.0;
  EXPECT_EQ(message_of(function), "");
}

TEST(SizeFunction, GrowthRateMustBeOneOrMore) {
  for (const SizeFunction& good : {mesh_function(), fixed_function()}) {
    for (const double bad : {0.999, 0.0, -1.2, not_a_number, infinite, -infinite}) {
      SCOPED_TRACE(bad);
      expect_error(good, [=](SizeFunction& f) { f.growth_rate = bad; }, {"growth rate"});
    }
  }
  expect_error(mesh_function(), [](SizeFunction& f) { f.growth_rate = 0.5; }, {"0.5"});
}

TEST(SizeFunction, SizeLimitMustBePositiveAndFinite) {
  for (const SizeFunction& good : {mesh_function(), fixed_function()}) {
    for (const double bad : {0.0, -2.0, not_a_number, infinite, -infinite}) {
      SCOPED_TRACE(bad);
      expect_error(good, [=](SizeFunction& f) { f.size_limit = bad; }, {"size limit"});
    }
  }
  expect_error(mesh_function(), [](SizeFunction& f) { f.size_limit = -2.5; }, {"-2.5"});
}

TEST(SizeFunction, FixedSizeMustBePositiveAndFinite) {
  for (const double bad : {0.0, -0.25, not_a_number, infinite}) {
    SCOPED_TRACE(bad);
    expect_error(fixed_function(), [=](SizeFunction& f) { f.start_size = bad; }, {"the size is"});
  }
  expect_error(fixed_function(), [](SizeFunction& f) { f.start_size = -0.25; }, {"-0.25"});
}

TEST(SizeFunction, NeedsSourcesAndAttachments) {
  for (const SizeFunction& good : {mesh_function(), fixed_function()}) {
    expect_error(good, [](SizeFunction& f) { f.sources.clear(); }, {"source"});
    expect_error(good, [](SizeFunction& f) { f.attachments.clear(); }, {"attachment"});
  }
}

TEST(SizeFunction, EntitiesMustBeInTheModel) {
  for (const SizeFunction& good : {mesh_function(), fixed_function()}) {
    expect_error(good,
                 [](SizeFunction& f) {
                   f.sources.push_back({2, 77});
                 },
                 {"source", "Surface 77"});
    expect_error(good,
                 [](SizeFunction& f) {
                   f.attachments.push_back({1, 88});
                 },
                 {"attachment", "Curve 88"});
  }
  expect_error(fixed_function(),
               [](SizeFunction& f) {
                 f.sources.push_back({0, 5});
               },
               {"source", "Point 5"});
}

TEST(SizeFunction, MeshSourceMustBeACurveOrSurface) {
  expect_error(mesh_function(),
               [](SizeFunction& f) {
                 f.sources.push_back({0, 1});
               },
               {"source", "Point 1"});
  expect_error(mesh_function(),
               [](SizeFunction& f) {
                 f.sources.push_back({3, 2});
               },
               {"source", "Volume 2"});
}

TEST(SizeFunction, AttachmentMustNotBeAPoint) {
  for (const SizeFunction& good : {mesh_function(), fixed_function()}) {
    expect_error(good,
                 [](SizeFunction& f) {
                   f.attachments.push_back({0, 3});
                 },
                 {"attachment", "Point 3"});
  }
}

TEST(SizeFunction, DimensionsBeyondTheModelsAreErrors) {
  for (const SizeFunction& good : {mesh_function(), fixed_function()}) {
    for (const int dim : {-1, 4}) {
      expect_error(good, [=](SizeFunction& f) { f.sources.push_back({dim, 1}); }, {"source"});
      expect_error(good,
                   [=](SizeFunction& f) {
                     f.attachments.push_back({dim, 1});
                   },
                   {"attachment"});
    }
  }
}

TEST(SizeFunction, MeshSourceMustNotBeItsOwnAttachment) {
  expect_error(mesh_function(),
               [](SizeFunction& f) {
                 f.attachments.push_back({2, 1});
               },
               {"Surface 1"});
  expect_error(mesh_function(), [](SizeFunction& f) { f.sources.push_back({1, 4}); }, {"Curve 4"});
}

// ==== Curvature and proximity

/// Two volumes that share surface 3; surface 2 with curves 1 and 2; curve 4 embedded in volume 2.
Topology two_volumes() {
  Topology topology;
  for (int tag = 1; tag <= 4; ++tag) {
    topology.add_entity({0, tag}, {});
    topology.add_entity({1, tag}, {{0, tag}});
  }
  topology.add_entity({2, 1}, {{1, 1}});
  topology.add_entity({2, 2}, {{1, 1}, {1, 2}});
  topology.add_entity({2, 3}, {{1, 2}, {1, 3}});
  topology.add_entity({2, 4}, {{1, 3}});
  topology.add_entity({3, 1}, {{2, 1}, {2, 2}, {2, 3}});
  topology.add_entity({3, 2}, {{2, 3}, {2, 4}, {1, 4}});
  return topology;
}

SizeFunction of_kind(Kind kind, std::vector<Entity> sources, std::vector<Entity> attachments) {
  SizeFunction function = mesh_function();
  function.kind = kind;
  function.sources = std::move(sources);
  function.attachments = std::move(attachments);
  return function;
}

SizeFunction curvature_function() { return of_kind(Kind::curvature, {{3, 1}, {1, 4}}, {{3, 2}}); }
SizeFunction proximity_function() { return of_kind(Kind::proximity, {{3, 1}}, {{3, 1}}); }

std::string message_in_two_volumes(const SizeFunction& function) {
  try {
    validate(function, "Function under test", two_volumes());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(SizeFunction, CurvatureAndProximityMayActOnTheirSources) {
  EXPECT_EQ(message_in_two_volumes(curvature_function()), "");
  EXPECT_EQ(message_in_two_volumes(proximity_function()), "");
  EXPECT_EQ(message_in_two_volumes(of_kind(Kind::curvature, {{2, 1}}, {{2, 1}})), "");
}

TEST(SizeFunction, CurvatureAndProximityHaveNoPointsAsSources) {
  for (const Kind kind : {Kind::curvature, Kind::proximity}) {
    EXPECT_NE(message_in_two_volumes(of_kind(kind, {{0, 1}}, {{3, 1}})).find("Point 1"),
              std::string::npos);
  }
}

TEST(SizeFunction, AngleCellsAndSmallestSizeHaveRanges) {
  const auto expect = [](SizeFunction function, double SizeFunction::*value, double bad,
                         const std::string& name) {
    function.*value = bad;
    const std::string message = message_in_two_volumes(function);
    EXPECT_NE(message.find(name), std::string::npos) << bad << ": " << message;
  };
  for (const double bad : {0.0, -18.0, 181.0, not_a_number, infinite}) {
    expect(curvature_function(), &SizeFunction::angle, bad, "angle");
  }
  for (const double bad : {0.0, -3.0, 1e9, not_a_number, infinite}) {
    expect(proximity_function(), &SizeFunction::cells_per_gap, bad, "cells per gap");
  }
  for (const double bad : {-1.0, 2.5, not_a_number, infinite}) {  // the limit is 2
    expect(curvature_function(), &SizeFunction::min_size, bad, "smallest size");
    expect(proximity_function(), &SizeFunction::min_size, bad, "smallest size");
  }
}

TEST(SizeFunction, VolumesStandForTheirFacesAsSourcesOfCurvature) {
  EXPECT_EQ(curvature_sources(curvature_function(), two_volumes()),
            (std::set<Entity>{{1, 4}, {2, 1}, {2, 2}, {2, 3}}));
  EXPECT_EQ(curvature_sources(of_kind(Kind::curvature, {{2, 2}}, {{3, 1}}), two_volumes()),
            (std::set<Entity>{{2, 2}}));
}

TEST(SizeFunction, SurfacesStandForTheirCurvesAsWellWhereThereAreNoVolumes) {
  Topology topology;
  topology.add_entity({0, 1}, {});
  topology.add_entity({1, 1}, {{0, 1}});
  topology.add_entity({1, 2}, {{0, 1}});
  topology.add_entity({2, 1}, {{1, 1}, {0, 1}});
  EXPECT_EQ(curvature_sources(of_kind(Kind::curvature, {{2, 1}}, {{2, 1}}), topology),
            (std::set<Entity>{{1, 1}, {2, 1}}));
}

/// Regions as "3.1: 2.1 2.3; …".
std::string regions(const SizeFunction& function, GapsBetween between = GapsBetween::automatic) {
  SizeFunction wanted = function;
  wanted.between = between;
  std::string text;
  const auto name = [](const Entity& e) {
    return std::to_string(e.dim) + "." + std::to_string(e.tag);
  };
  for (const GapRegion& region : gap_regions(wanted, two_volumes())) {
    text += (text.empty() ? "" : "; ") + name(region.region) + ":";
    for (const Entity& source : region.sources) {
      text += " " + name(source);
    }
  }
  return text;
}

TEST(SizeFunction, GapsAreMeasuredInsideAttachments) {
  const std::string faces = "3.1: 2.1 2.2 2.3";
  EXPECT_EQ(regions(proximity_function()), faces);
  EXPECT_EQ(regions(proximity_function(), GapsBetween::faces), faces);
  const std::string edges = "2.1: 1.1; 2.2: 1.1 1.2; 2.3: 1.2 1.3";
  EXPECT_EQ(regions(proximity_function(), GapsBetween::edges), edges);
  EXPECT_EQ(regions(proximity_function(), GapsBetween::both), edges + "; " + faces);
  // The common face, through the other volume.
  EXPECT_EQ(regions(of_kind(Kind::proximity, {{3, 1}}, {{3, 2}})), "3.2: 2.3");
  // Surfaces attached by themselves, and curves as sources: edges.
  EXPECT_EQ(regions(of_kind(Kind::proximity, {{2, 2}}, {{2, 2}})), "2.2: 1.1 1.2");
  EXPECT_EQ(regions(of_kind(Kind::proximity, {{1, 2}}, {{3, 1}})), "2.2: 1.2; 2.3: 1.2");
  EXPECT_EQ(regions(of_kind(Kind::proximity, {{2, 4}}, {{3, 1}})), "");
}

TEST(SizeFunction, ProximityWithoutAGapToMeasureIsAnError) {
  for (const SizeFunction& function :
       {of_kind(Kind::proximity, {{2, 4}}, {{3, 1}}), of_kind(Kind::proximity, {{1, 4}}, {{3, 2}}),
        of_kind(Kind::proximity, {{2, 1}}, {{1, 1}})}) {
    const std::string message = message_in_two_volumes(function);
    EXPECT_NE(message.find("bounds an attachment"), std::string::npos) << message;
    EXPECT_NE(message.find(entity_name(function.sources[0])), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace meshgrow
