#include "field_summary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "text_table.h"

namespace meshgrow {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// A volume with a surface around it and one function from each of two points.
SizeField field_of(Evaluator evaluator) {
  Topology topology;
  topology.add_entity({0, 5}, {}, Box(Vec3(0, 0, 0), Vec3(0, 0, 0)));
  topology.add_entity({0, 6}, {}, Box(Vec3(1, 1, 1), Vec3(1, 1, 1)));
  topology.add_entity({2, 1}, {}, Box(Vec3(0, 0, 0), Vec3(1, 1, 1)));
  topology.add_entity({3, 1}, {{2, 1}}, Box(Vec3(0, 0, 0), Vec3(1, 1, 1)));
  FieldOptions options;
  options.evaluator = evaluator;
  SizeField field(topology, options);
  SizeFunction function;
  function.kind = Kind::fixed;
  function.sources = {{0, 5}};
  function.attachments = {{3, 1}};
  function.start_size = 0.125;
  function.growth_rate = 1.25;
  function.size_limit = 2.5;
  field.add(function);
  function.sources = {{0, 6}};
  field.add(function);
  FacetedSource source;
  source.points.assign(1250, Vec3(0, 0, 0));
  field.set_sources(0, {source});
  field.build();
  return field;
}

bool has(const std::string& line, const std::string& part) {
  return line.find(part) != std::string::npos;
}

TEST(SummaryTable, HasALineForEachFunctionAndGroup) {
  const std::string text = field_of(Evaluator::grid).summary();
  const std::vector<std::string> lines = lines_of(text);
  ASSERT_EQ(lines.size(), 6u) << text;
  for (const char* const part :
       {"Fixed size function 1", "Point 5", "Volume 1", "1.25", "2.5", "size 0.125", "1,250"}) {
    EXPECT_TRUE(has(lines[1], part)) << "'" << part << "' in:\n" << text;
  }
  EXPECT_FALSE(has(lines[1], "no effect")) << text;
  EXPECT_TRUE(has(lines[2], "Fixed size function 2") && has(lines[2], "no effect")) << text;
  EXPECT_EQ(lines[3], "");
  for (const char* const part : {"facets", "grid cells", "depth", "seconds", "sizes answered"}) {
    EXPECT_TRUE(has(lines[4], part)) << "'" << part << "' in:\n" << text;
  }
  for (const char* const part : {"Group 1", "Volume 1 and Surface 1", "1, 2", "1,250"}) {
    EXPECT_TRUE(has(lines[5], part)) << "'" << part << "' in:\n" << text;
  }
  EXPECT_FALSE(has(lines[5], "no grid")) << text;
  EXPECT_TRUE(has(field_of(Evaluator::exact).summary(), "no grid"));
}

TEST(SummaryTable, CountsAnswers) {
  const SizeField field = field_of(Evaluator::exact);
  const std::vector<Vec3> points(2000, Vec3(0.5, 0.5, 0.5));
  std::vector<double> sizes(points.size());
  field.sizes({3, 1}, points.data(), points.size(), sizes.data());
  const std::string last = lines_of(field.summary()).back();
  EXPECT_TRUE(has(last, "2,000") && has(last, "100 %")) << last;
}

TEST(SummaryTable, OfNothingIsEmpty) { EXPECT_EQ(SizeField(Topology()).summary(), ""); }

TEST(TextTable, LinesUpColumns) {
  EXPECT_EQ(
      text_table({{"name", "n", "text"}, {"ä", "10", "b"}, {"longer", "1", "long text"}}, {2}),
      "name     n  text\n"
      "ä       10  b\n"
      "longer   1  long text\n");
}

}  // namespace
}  // namespace meshgrow
