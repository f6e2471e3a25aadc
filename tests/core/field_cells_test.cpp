#include "field_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "error.h"
#include "field_files.h"
#include "random_facets.h"

namespace meshgrow {
namespace {

const Entity left_volume = {3, 1};
const Entity right_volume = {3, 2};
const Entity corner = {0, 1};
const Entity end = {0, 2};
const Entity lone_point = {0, 9};

/// Two unit cubes side by side along x, each with a point, and a point without any function.
Topology two_cubes() {
  Topology topology;
  topology.add_entity(corner, {}, Box(Vec3(0, 0, 0), Vec3(0, 0, 0)));
  topology.add_entity(end, {}, Box(Vec3(2, 1, 1), Vec3(2, 1, 1)));
  topology.add_entity(lone_point, {}, Box(Vec3(1, 0.5, 0.5), Vec3(1, 0.5, 0.5)));
  topology.add_entity(left_volume, {corner}, Box(Vec3(0, 0, 0), Vec3(1, 1, 1)));
  topology.add_entity(right_volume, {end}, Box(Vec3(1, 0, 0), Vec3(2, 1, 1)));
  return topology;
}

SizeFunction fixed(const Entity& source, const Entity& attachment, double size, double limit) {
  SizeFunction function;
  function.kind = Kind::fixed;
  function.sources = {source};
  function.attachments = {attachment};
  function.start_size = size;
  function.growth_rate = 1.5;
  function.size_limit = limit;
  return function;
}

/// A function on each cube, from a point at its far corner.
SizeField two_functions(Evaluator evaluator) {
  FieldOptions options;
  options.evaluator = evaluator;
  options.threads = 1;
  SizeField field(two_cubes(), options);
  field.add(fixed(corner, left_volume, 0.02, 0.3));
  field.add(fixed(end, right_volume, 0.05, 0.25));
  FacetedSource source;
  source.entity = corner;
  source.points = {Vec3(0, 0, 0)};
  field.set_sources(0, {source});
  source.entity = end;
  source.points = {Vec3(2, 1, 1)};
  field.set_sources(1, {source});
  field.build();
  return field;
}

double grown(double start, double limit, double distance) {
  return std::min(limit, start + distance / 3.0);
}

double left_size(const Vec3& p) { return grown(0.02, 0.3, p.norm()); }
double right_size(const Vec3& p) { return grown(0.05, 0.25, (p - Vec3(2, 1, 1)).norm()); }

std::vector<Vec3> random_points(std::size_t count, const Box& box, unsigned seed) {
  test::Random random(seed);
  std::vector<Vec3> points;
  while (points.size() < count) {
    points.push_back(test::random_in_box(random, box));
  }
  return points;
}

const Box both_cubes(Vec3(0, 0, 0), Vec3(2, 1, 1));

/// The cell around a point; fails if there is not exactly one.
const FieldCell* cell_at(const FieldCells& cells, const Vec3& p) {
  const FieldCell* found = nullptr;
  int count = 0;
  for (const FieldCell& cell : cells.cells) {
    const Box box(cells.corner(cell, 0), cells.corner(cell, 7));
    if (((p - box.min()).array() >= 0.0).all() && ((box.max() - p).array() > 0.0).all()) {
      found = &cell;
      ++count;
    }
  }
  EXPECT_EQ(count, 1) << p.transpose();
  return found;
}

double interpolated(const FieldCells& cells, const FieldCell& cell, const Vec3& p) {
  const Vec3 lowest = cells.corner(cell, 0);
  const Vec3 local = (p - lowest).cwiseQuotient(cells.corner(cell, 7) - lowest);
  return trilinear(cell.sizes, local.x(), local.y(), local.z());
}

// ==== The smallest size of all groups

TEST(SmallestSizes, AreTheMinimumOverGroups) {
  const std::vector<Vec3> points = random_points(2000, both_cubes, 3);
  std::vector<double> sizes(points.size());
  std::vector<std::size_t> groups(points.size());
  const SizeField field = two_functions(Evaluator::exact);
  field.smallest_sizes(points.data(), points.size(), sizes.data(), groups.data());
  std::map<std::size_t, int> decided;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double left = left_size(points[i]);
    const double right = right_size(points[i]);
    ASSERT_NEAR(sizes[i], std::min(left, right), 1e-12) << points[i].transpose();
    const std::size_t function = field.groups()[groups[i]].functions.front();
    ASSERT_EQ(function, left < right ? 0u : 1u) << points[i].transpose();
    ++decided[groups[i]];
  }
  EXPECT_GT(decided[0], 100);
  EXPECT_GT(decided[1], 100);
}

TEST(SmallestSizes, ComeFromGridsWithinTheirTolerance) {
  const std::vector<Vec3> points = random_points(2000, both_cubes, 4);
  std::vector<double> sizes(points.size());
  const SizeField field = two_functions(Evaluator::grid);
  field.smallest_sizes(points.data(), points.size(), sizes.data());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double exact = std::min(left_size(points[i]), right_size(points[i]));
    ASSERT_LE(sizes[i], 1.05 * exact);
    ASSERT_GE(sizes[i], 0.9 * exact);
  }
}

TEST(SmallestSizes, OfNoGroupAndAtNoPoint) {
  const SizeField empty(two_cubes(), {});
  const Vec3 p(0.5, 0.5, 0.5);
  double size = 0.0;
  empty.smallest_sizes(&p, 1, &size);
  EXPECT_EQ(size, SizeField::no_size);
  const Vec3 nowhere(std::nan(""), 0.0, 0.0);
  two_functions(Evaluator::exact).smallest_sizes(&nowhere, 1, &size);
  EXPECT_EQ(size, SizeField::no_size);
}

TEST(AnsweringTogether, AsksAllFacetsOnce) {
  SizeField field = two_functions(Evaluator::exact);
  field.add(fixed(lone_point, left_volume, 0.1, 0.35));
  FacetedSource source;
  source.entity = lone_point;
  source.points = {Vec3(1, 0.5, 0.5)};
  field.set_sources(2, {source});
  field.add(fixed(end, left_volume, 0.05, 0.25));  // the facet of the second function again
  source.entity = end;
  source.points = {Vec3(2, 1, 1)};
  field.set_sources(3, {source});
  field.build();
  const SizeField::Answering all = field.answering_together();
  EXPECT_EQ(all.tree->facets().size(), 3u);
  EXPECT_EQ(all.size_limit, 0.25);
  EXPECT_TRUE(all.box.isApprox(both_cubes));
  for (const Vec3& p : random_points(500, both_cubes, 5)) {
    double smallest = 0.0;
    field.smallest_sizes(&p, 1, &smallest);
    ASSERT_NEAR(all.tree->size(p, all.size_limit), smallest, 1e-12);
  }
}

// ==== Cells

TEST(FieldCells, InterpolateTheSmallestSizeWithinTheTolerance) {
  const SizeField field = two_functions(Evaluator::exact);
  const FieldCells cells = field_cells(field, std::nullopt, CellUse::interpolate);
  // Points of the boundary are inside, in spite of rounding.
  std::vector<Vec3> points = random_points(300, both_cubes, 6);
  points.insert(points.end(), {Vec3(0, 0, 0), Vec3(2, 1, 1), Vec3(2, 0, 1), Vec3(1, 1, 0)});
  for (const Vec3& p : points) {
    const FieldCell* cell = cell_at(cells, p);
    ASSERT_NE(cell, nullptr);
    const double exact = std::min(left_size(p), right_size(p));
    const double size = interpolated(cells, *cell, p);
    EXPECT_LE(size, 1.05 * exact) << p.transpose();
    EXPECT_GE(size, 0.9 * exact) << p.transpose();
    EXPECT_FALSE(cell->exact);
  }
  // Nothing far away from the model, though the grid is a cube.
  for (const FieldCell& cell : cells.cells) {
    EXPECT_LT(cells.corner(cell, 0).y(), 1.1);
  }
}

TEST(FieldCells, ThatMayBeFewWarnOfTheToleranceTheyReach) {
  SizeField field = two_functions(Evaluator::exact);
  std::vector<std::string> warnings;
  field.options().warn = [&](const std::string& sentence) { warnings.push_back(sentence); };
  const std::size_t needed = field_cells(field, std::nullopt, CellUse::interpolate).cells.size();
  EXPECT_TRUE(warnings.empty());
  field.options().max_cells = needed / 10;
  EXPECT_LE(field_cells(field, std::nullopt, CellUse::interpolate).cells.size(), needed / 10);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find(" % instead of 5 %; raise max_cells"), std::string::npos)
      << warnings[0];
}

TEST(FieldCells, OfOneEntityAreThoseOfItsGroup) {
  const SizeField field = two_functions(Evaluator::exact);
  const FieldCells cells = field_cells(field, right_volume, CellUse::interpolate);
  for (const Vec3& p : random_points(200, Box(Vec3(1, 0, 0), Vec3(2, 1, 1)), 7)) {
    const FieldCell* cell = cell_at(cells, p);
    ASSERT_NE(cell, nullptr);
    EXPECT_NEAR(interpolated(cells, *cell, p), right_size(p), 0.1 * right_size(p));
  }
}

TEST(FieldCells, ShownAreTheGridsOwnWithExactOnesDivided) {
  const SizeField field = two_functions(Evaluator::grid);
  const FieldCells cells = field_cells(field, left_volume, CellUse::show);
  int exact_cells = 0;
  for (const Vec3& p : random_points(300, Box(Vec3(0, 0, 0), Vec3(1, 1, 1)), 8)) {
    const FieldCell* cell = cell_at(cells, p);
    ASSERT_NE(cell, nullptr);
    if (cell->exact) {
      ++exact_cells;
      EXPECT_NEAR(interpolated(cells, *cell, p), left_size(p), 0.25 * left_size(p));
    } else {
      EXPECT_NEAR(interpolated(cells, *cell, p), field.size(left_volume, p), 1e-6);
    }
  }
  EXPECT_GT(exact_cells, 0);
}

TEST(FieldCells, TellTheGroupThatDecides) {
  const SizeField field = two_functions(Evaluator::exact);
  const FieldCells cells = field_cells(field, std::nullopt, CellUse::show);
  const FieldCell* left = cell_at(cells, Vec3(0.001, 0.001, 0.001));
  const FieldCell* right = cell_at(cells, Vec3(1.999, 0.999, 0.999));
  EXPECT_EQ(field.groups()[left->group].functions, std::vector<std::size_t>{0});
  EXPECT_EQ(field.groups()[right->group].functions, std::vector<std::size_t>{1});
}

TEST(FieldCells, WhereNoFunctionActsAreAnError) {
  const SizeField field = two_functions(Evaluator::exact);
  try {
    field_cells(field, lone_point, CellUse::show);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("Point 9"), std::string::npos) << error.what();
  }
  EXPECT_THROW(field_cells(SizeField(two_cubes(), {}), std::nullopt, CellUse::show), Error);
}

TEST(SharedNodes, HaveTheSmallestSizeOfTheCellsThere) {
  const SizeField field = two_functions(Evaluator::exact);
  const FieldCells cells = field_cells(field, std::nullopt, CellUse::interpolate);
  const SharedNodes nodes = shared_nodes(cells);
  ASSERT_EQ(nodes.of_cell.size(), cells.cells.size());
  EXPECT_LT(nodes.places.size(), 3 * cells.cells.size());
  std::vector<float> smallest(nodes.places.size(), 1e30f);
  for (std::size_t i = 0; i < cells.cells.size(); ++i) {
    for (int k = 0; k < 8; ++k) {
      const int corner = hexahedron_corners[k];
      const std::uint32_t node = nodes.of_cell[i][k];
      ASSERT_EQ(cells.cube.at(nodes.places[node]), cells.corner(cells.cells[i], corner));
      smallest[node] = std::min(smallest[node], cells.cells[i].sizes[corner]);
    }
  }
  EXPECT_EQ(nodes.sizes, smallest);
}

// ==== Files

TEST(FieldFiles, PosHoldsEachCellWithItsSizes) {
  const SizeField field = two_functions(Evaluator::exact);
  const FieldCells cells = field_cells(field, std::nullopt, CellUse::interpolate);
  std::ostringstream file;
  write_pos(cells, "two words", file);
  const std::string text = file.str();
  const std::string head = "$PostFormat\n1.4 1 8\n$EndPostFormat\n$View\ntwo^words 1 ";
  ASSERT_EQ(text.substr(0, head.size()), head);
  const std::size_t data = text.find('\n', head.size()) + 1;
  ASSERT_EQ(text.size(), data + 4 + 8 + 256 * cells.cells.size() + std::strlen("\n$EndView\n"));
  double numbers[32];
  std::memcpy(numbers, text.data() + data + 12, sizeof(numbers));
  const Vec3 opposite = cells.corner(cells.cells[0], 7);
  EXPECT_EQ(Vec3(numbers[6], numbers[14], numbers[22]), opposite);
  EXPECT_EQ(numbers[30], cells.cells[0].sizes[7]);
}

}  // namespace
}  // namespace meshgrow
