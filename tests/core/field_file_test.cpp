#include "field_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "ball_and_cube.h"
#include "checked_blocks.h"
#include "error.h"
#include "graded_sphere.h"
#include "random_facets.h"
#include "test_with_folder.h"

namespace meshgrow {
namespace {

namespace fs = std::filesystem;

using test::other_surface;
using test::other_volume;
using test::surface;
using test::volume;

Topology named_ball_and_cube() {
  Topology topology = test::ball_and_cube();
  topology.add_physical_group({2, 5, "the \"wall\" ü", {surface}});
  return topology;
}

constexpr double growth_rate = 1.2345678901234567;
constexpr double size_limit = 0.7;

SizeFunction mesh_function() { return test::mesh_in_ball(growth_rate, size_limit); }

/// The sphere's mesh grows into the first volume; a fixed function is without effect in the second.
SizeField ball_field(std::size_t triangles, Evaluator evaluator = Evaluator::grid) {
  FieldOptions options;
  options.evaluator = evaluator;
  SizeField field(named_ball_and_cube(), options);
  field.add(mesh_function());
  field.add(test::fixed_in_cube(growth_rate, size_limit));
  FacetedSource source;
  source.entity = surface;
  source.triangles = test::graded_sphere(triangles, 10.0);
  field.set_sources(0, {source});
  field.build_grids();
  return field;
}

using FieldFile = test::TestWithFolder;
using test::bytes_of;

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::uint64_t number_at(const std::string& bytes, std::size_t place) {
  std::uint64_t result = 0;
  std::memcpy(&result, bytes.data() + place, sizeof(result));
  return result;
}

std::vector<Vec3> random_points(test::Random& random, std::size_t count) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 direction = test::random_in_ball(random, 1.0);
    points.push_back(i % 3 == 0   ? Vec3(3.0 * direction)
                     : i % 3 == 1 ? Vec3(direction.normalized() * (1.0 + 1e-3 * direction.x()))
                                  : Vec3(1e6 * direction));
  }
  return points;
}

/// Asks both for all there is to ask; identical to the bit.
void expect_equal_answers(const SizeField& a, const SizeField& b, unsigned seed) {
  test::Random random(seed);
  const std::vector<Vec3> points = random_points(random, 3000);
  std::vector<double> from_a(points.size());
  std::vector<double> from_b(points.size());
  for (const Entity& entity : {surface, volume, other_surface, other_volume, Entity{1, 77}}) {
    ASSERT_EQ(a.acts_on(entity), b.acts_on(entity));
    a.sizes(entity, points.data(), points.size(), from_a.data());
    b.sizes(entity, points.data(), points.size(), from_b.data());
    ASSERT_EQ(from_a, from_b) << "seed " << seed;
    a.exact_sizes(entity, points.data(), points.size(), from_a.data());
    b.exact_sizes(entity, points.data(), points.size(), from_b.data());
    ASSERT_EQ(from_a, from_b) << "seed " << seed;
    for (std::size_t i = 0; i < points.size(); i += 7) {
      ASSERT_EQ(a.size(entity, points[i]), b.size(entity, points[i])) << "seed " << seed;
    }
  }
}

std::string sentence_of_loading(const std::string& path) {
  try {
    load_field(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// What is said when every size of the loaded field is asked for; "" if nothing.
std::string sentence_of_using(const std::string& path) {
  try {
    const SizeField field = load_field(path);
    test::Random random(1);
    for (const Vec3& p : random_points(random, 3000)) {
      field.size(volume, p);
      field.exact_size(volume, p);
    }
    save_field(field, path + ".again");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST_F(FieldFile, AnswersTheSameToTheBitWithAndWithoutGrids) {
  for (const Evaluator evaluator : {Evaluator::grid, Evaluator::automatic, Evaluator::exact}) {
    const SizeField field = ball_field(3000, evaluator);
    save_field(field, path("a.mgf"));
    const SizeField loaded = load_field(path("a.mgf"));
    expect_equal_answers(field, loaded, 7);
    EXPECT_EQ(loaded.groups()[0].has_grid, evaluator != Evaluator::exact);
  }
}

TEST_F(FieldFile, KeepsFunctionsGroupsAndModel) {
  const SizeField field = ball_field(2000);
  save_field(field, path("a.mgf"));
  const SizeField loaded = load_field(path("a.mgf"));
  ASSERT_EQ(loaded.groups().size(), field.groups().size());
  for (std::size_t i = 0; i < loaded.groups().size(); ++i) {
    const SizeField::GroupSummary a = loaded.groups()[i];
    const SizeField::GroupSummary b = field.groups()[i];
    EXPECT_EQ(a.entities, b.entities);
    EXPECT_EQ(a.functions, b.functions);
    EXPECT_EQ(a.facets, b.facets);
    EXPECT_EQ(a.size_limit, b.size_limit);
    EXPECT_EQ(a.tree_bytes, b.tree_bytes);
    EXPECT_EQ(a.grid.interpolated_leaves, b.grid.interpolated_leaves);
    EXPECT_EQ(a.grid.exact_leaves, b.grid.exact_leaves);
    EXPECT_EQ(a.grid.depth, b.grid.depth);
    EXPECT_EQ(a.grid.bytes, b.grid.bytes);
  }
  ASSERT_EQ(loaded.functions().size(), 2u);
  EXPECT_EQ(loaded.functions()[0].growth_rate, 1.2345678901234567);
  EXPECT_TRUE(loaded.is_effective(0));
  EXPECT_FALSE(loaded.is_effective(1));
  EXPECT_EQ(loaded.options().tolerance, field.options().tolerance);
  ASSERT_EQ(loaded.topology().physical_groups().size(), 1u);
  EXPECT_EQ(loaded.topology().physical_groups()[0].name, "the \"wall\" ü");
  EXPECT_EQ(loaded.topology().entities(), field.topology().entities());
}

TEST_F(FieldFile, EqualFieldsMakeEqualFiles) {
  const SizeField field = ball_field(2000);
  save_field(field, path("a.mgf"));
  save_field(field, path("b.mgf"));
  save_field(load_field(path("a.mgf")), path("c.mgf"));
  save_field(ball_field(2000), path("d.mgf"));
  const std::string bytes = bytes_of(path("a.mgf"));
  EXPECT_EQ(bytes.substr(0, 8), "\x89MGF\r\n\x1a\n");
  EXPECT_EQ(number_at(bytes, 16), bytes.size());
  EXPECT_TRUE(bytes == bytes_of(path("b.mgf")));
  EXPECT_TRUE(bytes == bytes_of(path("c.mgf")));
  EXPECT_TRUE(bytes == bytes_of(path("d.mgf")));
  EXPECT_TRUE(is_field_file(path("a.mgf")));
}

TEST_F(FieldFile, AFieldThatIsNotBuiltIsNotSaved) {
  SizeField field(named_ball_and_cube());
  field.add(mesh_function());
  EXPECT_THROW(save_field(field, path("a.mgf")), Error);
  EXPECT_FALSE(fs::exists(path("a.mgf")));
}

TEST_F(FieldFile, AFileThatCannotBeWrittenIsNamed) {
  const SizeField field = ball_field(500);
  try {
    save_field(field, path("missing/a.mgf"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("missing/a.mgf (No such file"), std::string::npos)
        << error.what();
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(FieldFile, ForeignFilesGetOneSentence) {
  EXPECT_NE(sentence_of_loading(path("none.mgf")).find("Cannot read"), std::string::npos);
  EXPECT_NE(sentence_of_loading(folder_.string()).find("directory"), std::string::npos);
  for (const std::string& bytes :
       {std::string(), std::string("\x89"), std::string("$MeshFormat\n4.1 0 8\n"),
        std::string(5000, '\0'), std::string("\x89MGF\n\x1a\n") + std::string(100, 'x')}) {
    write(path("foreign.mgf"), bytes);
    EXPECT_NE(sentence_of_loading(path("foreign.mgf")).find("no size field"), std::string::npos);
    EXPECT_FALSE(is_field_file(path("foreign.mgf")));
  }
}

TEST_F(FieldFile, TruncatedFilesGetOneSentence) {
  save_field(ball_field(500), path("a.mgf"));
  const std::string bytes = bytes_of(path("a.mgf"));
  for (std::size_t size = 8; size < bytes.size(); size = size < 100 ? size + 1 : size * 5 / 4) {
    write(path("cut.mgf"), bytes.substr(0, size));
    const std::string sentence = sentence_of_loading(path("cut.mgf"));
    EXPECT_NE(sentence.find("truncated"), std::string::npos) << size << ": " << sentence;
  }
  write(path("long.mgf"), bytes + "x");
  EXPECT_NE(sentence_of_loading(path("long.mgf")), "");
}

TEST_F(FieldFile, AnotherVersionIsNamed) {
  save_field(ball_field(500), path("a.mgf"));
  std::string bytes = bytes_of(path("a.mgf"));
  bytes[8] = 2;
  write(path("a.mgf"), bytes);
  EXPECT_NE(sentence_of_loading(path("a.mgf")).find("version 2"), std::string::npos);
}

TEST_F(FieldFile, EveryDamagedByteIsNoticed) {
  const unsigned seed = 20261125;
  const std::string good = path("a.mgf");
  save_field(ball_field(500), good);
  const std::string bytes = bytes_of(good);
  ASSERT_EQ(sentence_of_using(good), "");
  test::Random random(seed);
  const std::size_t directory = number_at(bytes, 24);
  for (int i = 0; i < 400; ++i) {
    // Half of them where the file is described, one bit each.
    const std::size_t place = i % 4 == 0 ? test::random_index(random, 64)
                              : i % 4 == 1
                                  ? directory + test::random_index(random, bytes.size() - directory)
                                  : test::random_index(random, directory);
    std::string damaged = bytes;
    damaged[place] = static_cast<char>(damaged[place] ^ 1 << test::random_index(random, 8));
    write(path("damaged.mgf"), damaged);
    const std::string sentence = sentence_of_using(path("damaged.mgf"));
    const bool is_gap = place >= 64 && place < directory;  // arrays begin at multiples of 64
    EXPECT_TRUE(!sentence.empty() || is_gap) << place << ", seed " << seed;
    if (sentence.empty()) {
      // In a gap: written again as zeros.
      EXPECT_TRUE(bytes_of(path("damaged.mgf.again")) == bytes) << place << ", seed " << seed;
    }
    fs::remove(path("damaged.mgf.again"));
  }
}

TEST_F(FieldFile, BlocksAreCheckedWhenTouchedAndNotBefore) {
  save_field(ball_field(20000), path("a.mgf"));
  const std::string bytes = bytes_of(path("a.mgf"));
  const SizeField whole = load_field(path("a.mgf"));
  const SizeField::Parts parts = whole.parts();
  const StoredArray<GridCorners>& corners = parts.groups[0].grid->stored().corners;
  ASSERT_GT(corners.size(), 5000u);
  const std::string last(reinterpret_cast<const char*>(&corners[corners.size() - 1]),
                         sizeof(GridCorners));
  const std::size_t place = bytes.rfind(last);
  ASSERT_NE(place, std::string::npos);
  std::string damaged = bytes;
  damaged[place] = static_cast<char>(damaged[place] ^ 1);
  write(path("damaged.mgf"), damaged);
  const SizeField field = load_field(path("damaged.mgf"));
  const SizeField::Parts damaged_parts = field.parts();
  const StoredArray<GridCorners>& damaged_corners = damaged_parts.groups[0].grid->stored().corners;
  EXPECT_EQ(damaged_corners[0], corners[0]);
  EXPECT_THROW(damaged_corners[corners.size() - 1], Error);
  EXPECT_THROW(damaged_corners[corners.size() - 1], Error);  // and again
  EXPECT_EQ(damaged_corners[1], corners[1]);
}

TEST_F(FieldFile, ThreadsMayTouchTheSameBlocks) {
  const SizeField field = ball_field(3000);
  save_field(field, path("a.mgf"));
  test::Random random(3);
  const std::vector<Vec3> points = random_points(random, 2000);
  for (int round = 0; round < 10; ++round) {
    const SizeField loaded = load_field(path("a.mgf"));
    int different = 0;
#pragma omp parallel for num_threads(4) reduction(+ : different)
    for (std::size_t i = 0; i < points.size(); ++i) {
      different += loaded.size(volume, points[i]) != field.size(volume, points[i]) ? 1 : 0;
    }
    ASSERT_EQ(different, 0);
  }
}

}  // namespace
}  // namespace meshgrow
