// Memory that runs out at each step of what the core does.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "ball_and_cube.h"
#include "failing_steps.h"
#include "field_cells.h"
#include "field_file.h"
#include "field_files.h"
#include "graded_sphere.h"
#include "meshing_plan.h"
#include "size_field.h"
#include "size_function_text.h"
#include "test_with_folder.h"

namespace meshgrow {
namespace {

namespace fs = std::filesystem;
using test::fail_at_each_step;
using test::other_surface;
using test::other_volume;
using test::surface;
using test::volume;

SizeFunction mesh_function(double growth_rate = 1.2) {
  return test::mesh_in_ball(growth_rate, 1.0);
}

std::vector<FacetedSource> sphere(std::size_t triangles) {
  FacetedSource source;
  source.entity = surface;
  source.triangles = test::graded_sphere(triangles, 5.0);
  return {source};
}

/// Built, with a second function in a group of its own.
SizeField field_of(std::size_t triangles, int threads) {
  FieldOptions options;
  options.evaluator = Evaluator::grid;
  options.tolerance = 0.2;
  options.threads = threads;
  SizeField field(test::ball_and_cube(), options);
  field.add(mesh_function());
  field.add(test::fixed_in_cube(1.2, 1.0));
  field.set_sources(0, sphere(triangles));
  FacetedSource square;
  square.entity = other_surface;
  square.triangles = {{Vec3(3, 0, 0), Vec3(3, 1, 0), Vec3(3, 0, 1)}};
  field.set_sources(1, {square});
  field.build();
  return field;
}

/// Sizes in both volumes, to the bit.
std::vector<double> sizes_of(const SizeField& field) {
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) {
    points.push_back(Vec3(std::sin(1.1 * i), std::sin(1.7 * i + 1), std::sin(2.3 * i + 2)) * 2.0);
  }
  std::vector<double> sizes(2 * points.size());
  field.sizes(volume, points.data(), points.size(), sizes.data());
  field.sizes(other_volume, points.data(), points.size(), sizes.data() + points.size());
  return sizes;
}

void expect_usable(SizeField& field) {
  field.set_sources(0, sphere(80));
  field.build();
  EXPECT_LT(sizes_of(field).front(), 1.0);
}

class OutOfMemoryInThreads : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Count, OutOfMemoryInThreads, testing::Values(1, 4));

TEST_P(OutOfMemoryInThreads, AFieldThatIsBuiltAnewAnswersAsBefore) {
  const SizeField old = field_of(300, GetParam());
  const std::vector<double> before = sizes_of(old);
  const std::vector<FacetedSource> finer = sphere(3000);
  fail_at_each_step(
      150, [&old] { return old; },
      [&finer](SizeField& field) {
        field.set_sources(0, finer);
        field.build();
      },
      [&before](SizeField& field) {
        EXPECT_EQ(sizes_of(field), before);
        field.set_sources(0, sphere(400));
        field.build();
        EXPECT_NE(sizes_of(field), before);
      });
}

TEST(OutOfMemory, AFieldThatCannotBeChangedIsAsBefore) {
  const SizeField old = field_of(80, 1);
  const std::vector<double> before = sizes_of(old);
  const auto check = [&before](SizeField& field) {
    ASSERT_EQ(field.functions().size(), 2u);
    EXPECT_EQ(field.functions()[0].growth_rate, 1.2);
    EXPECT_EQ(field.functions()[1].kind, Kind::fixed);
    EXPECT_EQ(field.functions_on(volume), (std::vector<std::size_t>{0}));
    EXPECT_EQ(field.functions_on(other_volume), (std::vector<std::size_t>{1}));
    EXPECT_EQ(sizes_of(field), before);
    EXPECT_EQ(field.groups().size(), 2u);
    expect_usable(field);
  };
  const auto make = [&old] { return old; };
  fail_at_each_step(
      1000, make, [](SizeField& field) { field.add(mesh_function(1.3)); }, check);
  fail_at_each_step(
      1000, make, [](SizeField& field) { field.modify(0, mesh_function(1.3)); }, check);
  fail_at_each_step(
      1000, make, [](SizeField& field) { field.remove(0); }, check);
  fail_at_each_step(
      1000, make, [](SizeField& field) { field.rename(0, "a name that needs memory"); }, check);
}

TEST(OutOfMemory, ProximityIsAsBefore) {
  SizeField old(test::ball_and_cube());
  SizeFunction function = mesh_function();
  function.kind = Kind::proximity;
  function.cells_per_gap = 3.0;
  function.sources = {volume};
  function.attachments = {volume};
  old.add(function);
  // Two faces of a box without sides, this far apart.
  const auto faces = [](double gap) {
    std::vector<FacetedSource> result(2);
    for (std::size_t i = 0; i < 2; ++i) {
      const double z = gap * static_cast<double>(i);
      result[i].entity = i == 0 ? surface : other_surface;
      result[i].triangles = {{Vec3(0, 0, z), Vec3(1, 0, z), Vec3(0, 1, z)},
                             {Vec3(1, 0, z), Vec3(1, 1, z), Vec3(0, 1, z)}};
    }
    return result;
  };
  const GapRegion gaps = gap_regions(function, old.topology()).at(0);
  old.set_regions(0, {{gaps, volume_walls(faces(0.3))}});
  old.build();
  const std::vector<double> before = sizes_of(old);
  fail_at_each_step(
      200, [&old] { return old; },
      [&](SizeField& field) {
        field.set_regions(0, {{gaps, volume_walls(faces(0.1))}});
        field.build();
      },
      [&before](SizeField& field) { EXPECT_EQ(sizes_of(field), before); });
}

using OutOfMemoryWithFiles = test::TestWithFolder;

TEST_F(OutOfMemoryWithFiles, ASavedFieldStaysAsItWas) {
  const SizeField old = field_of(80, 1);
  const SizeField other = field_of(200, 1);
  const std::string path = this->path("a.mgf");
  save_field(old, path);
  const std::string bytes = test::bytes_of(path);
  const auto make = [&] {
    save_field(old, path);
    return 0;
  };
  fail_at_each_step(
      400, make, [&](int) { save_field(other, path); },
      [&](int) {
        EXPECT_TRUE(test::bytes_of(path) == bytes);
        EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
      });
  const std::vector<double> before = sizes_of(old);
  fail_at_each_step(
      400, make, [&](int) { load_field(path); },
      [&](int) { EXPECT_EQ(sizes_of(load_field(path)), before); });
}

TEST_F(OutOfMemoryWithFiles, TextsAreWholeOrNotAtAll) {
  const SizeField field = field_of(80, 1);
  const std::string summary = field.summary();
  const std::string function = size_function_text(mesh_function());
  std::string told;
  const auto check = [](int) {};
  fail_at_each_step(
      300, [] { return 0; },
      [&](int) {
        told = field.summary();
        EXPECT_EQ(told, summary);
      },
      check);
  fail_at_each_step(
      300, [] { return 0; },
      [&](int) {
        told = size_function_text(mesh_function());
        EXPECT_EQ(told, function);
        parse_size_function(function, field.topology());
      },
      check);
}

}  // namespace
}  // namespace meshgrow
