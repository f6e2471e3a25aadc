// Sources that nobody draws on purpose: what grids promise holds for them too, in bounded memory.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "random_facets.h"
#include "size_field.h"

namespace meshgrow {
namespace {

using Triangles = std::vector<std::array<Vec3, 3>>;

constexpr unsigned seed = 20261125;
const Entity surface = {2, 1};
const Entity volume = {3, 1};

std::array<Vec3, 3> triangle_at(const Vec3& at, double size) {
  return {at, Vec3(at + Vec3(size, 0, 0)), Vec3(at + Vec3(0, size, 0))};
}

SizeField field_of(const Triangles& triangles, const Box& box, double size_limit) {
  Topology topology;
  topology.add_entity(surface, {}, box);
  topology.add_entity(volume, {surface}, box);
  FieldOptions options;
  options.evaluator = Evaluator::grid;
  options.threads = 1;
  SizeField field(topology, options);
  SizeFunction function;
  function.sources = {surface};
  function.attachments = {volume};
  function.growth_rate = 1.2;
  function.size_limit = size_limit;
  field.add(function);
  FacetedSource source;
  source.entity = surface;
  source.triangles = triangles;
  field.set_sources(0, {source});
  field.build();
  return field;
}

/// At points of the box, and at some so near to the source as its elements are large.
void expect_promise(const SizeField& field, const Triangles& triangles, const Box& box,
                    std::size_t most_bytes) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  ASSERT_EQ(field.groups().size(), 1u);
  ASSERT_TRUE(field.groups()[0].has_grid);
  EXPECT_LT(field.groups()[0].grid.bytes, most_bytes);
  test::Random random(seed);
  for (int i = 0; i < 4000; ++i) {
    const Vec3 unit = 0.5 * (Vec3::Random() + Vec3::Ones());
    Vec3 p = box.min() + unit.cwiseProduct(box.sizes());
    if (i % 2 == 0) {
      const auto& [a, b, c] = triangles[test::random_index(random, triangles.size())];
      p = a + (b - a).norm() * 4.0 * (unit - Vec3::Constant(0.5));
    }
    const double exact = field.exact_size(volume, p);
    const double size = field.size(volume, p);
    ASSERT_LE(size, 1.05 * exact * (1 + 1e-9)) << p.transpose();
    ASSERT_GT(size, 0.5 * exact) << p.transpose();
  }
}

TEST(OddSources, OneFacet) {
  const Triangles one = {triangle_at(Vec3::Zero(), 0.1)};
  const Box box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  const SizeField field = field_of(one, box, 0.5);
  expect_promise(field, one, box, 1 << 22);
  // The mean edge at the facet, grown by the slope (g - 1) / g from there.
  const double start = 0.1 * (2 + std::sqrt(2.0)) / 3;
  EXPECT_NEAR(field.exact_size(volume, Vec3(0.02, 0.02, 0.6)), start + 0.6 / 6, 0.02);
}

TEST(OddSources, NoFacetHasNoSize) {
  const Box box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  const SizeField field = field_of({}, box, 0.5);
  EXPECT_EQ(field.size(volume, Vec3::Zero()), SizeField::no_size);
  const SizeField of_nan =
      field_of({{Vec3(std::nan(""), 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}}, box, 0.5);
  EXPECT_EQ(of_nan.size(volume, Vec3::Zero()), SizeField::no_size);
}

TEST(OddSources, AllFacetsAreTheSame) {
  const Triangles same(1000, triangle_at(Vec3(0.1, 0.2, 0.3), 0.05));
  const Box box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  expect_promise(field_of(same, box, 0.5), same, box, 1 << 22);
}

TEST(OddSources, SizesFromAMillionthToAMillion) {
  // Side by side, each half as large again as the one before: 68 of them.
  Triangles triangles;
  double x = 0.0;
  for (double size = 1e-6; size < 1e6; size *= 1.5) {
    triangles.push_back(triangle_at(Vec3(x, 0, 0), size));
    x += size;
  }
  const Box box(Vec3(-1e6, -1e6, -1e6), Vec3(x, 1e6, 1e6));
  expect_promise(field_of(triangles, box, 1e6), triangles, box, 1 << 24);
}

TEST(OddSources, SmallOnesAmongLargeOnes) {
  // Neighbours differ by 10¹², which no mesh should: 400 of a millionth on one of a million.
  Triangles triangles = {triangle_at(Vec3(-3e5, -3e5, 0), 1e6)};
  test::Random random(seed);
  for (std::size_t i = 0; i < 400; ++i) {
    const auto place = [&random] {
      return 1e3 * static_cast<double>(test::random_index(random, 1000));
    };
    triangles.push_back(triangle_at(Vec3(place(), place(), 0), 1e-6));
  }
  const Box box(Vec3(-1e6, -1e6, -1e6), Vec3(1e6, 1e6, 1e6));
  expect_promise(field_of(triangles, box, 1e6), triangles, box, 1 << 26);
}

TEST(OddSources, FarFromTheOrigin) {
  const Vec3 far(1e8, -1e8, 1e8);
  Triangles near;
  Triangles moved;
  for (int i = 0; i < 20; ++i) {
    // Halves and quarters, which the offset does not round.
    const Vec3 at(0.25 * i, 0.5 * (i % 3), 0.0);
    near.push_back(triangle_at(at, i % 2 == 0 ? 0.5 : 0.25));
    moved.push_back(triangle_at(at + far, i % 2 == 0 ? 0.5 : 0.25));
  }
  const Box box(Vec3(-8, -8, -8), Vec3(8, 8, 8));
  const Box box_of_moved(box.min() + far, box.max() + far);
  const SizeField field = field_of(moved, box_of_moved, 2.0);
  expect_promise(field, moved, box_of_moved, 1 << 24);
  const SizeField original = field_of(near, box, 2.0);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p(0.25 * (i % 32) - 4, 0.25 * (i % 13) - 1, 0.25 * (i % 7));
    EXPECT_NEAR(field.exact_size(volume, p + far), original.exact_size(volume, p), 1e-6);
  }
}

}  // namespace
}  // namespace meshgrow
