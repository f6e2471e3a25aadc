// A size field that is asked by several threads at once.

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "at_once.h"
#include "graded_sphere.h"
#include "random_facets.h"
#include "size_field.h"

namespace meshgrow {
namespace {

constexpr std::size_t point_count = 1000;
const Entity inner_volume = {3, 1};
const Entity outer_volume = {3, 2};

/// A unit sphere, surface 1, whose mesh grows into volume 1 within and volume 2 around it, at
/// different rates.
SizeField field_of_two_groups(Evaluator evaluator) {
  Topology topology;
  topology.add_entity({2, 1}, {}, test::cube(1.0));
  topology.add_entity(inner_volume, {{2, 1}}, test::cube(1.0));
  topology.add_entity(outer_volume, {{2, 1}}, test::cube(2.0));
  FieldOptions options;
  options.evaluator = evaluator;
  options.threads = test::thread_count;
  SizeField field(topology, options);
  FacetedSource source;
  source.entity = {2, 1};
  source.triangles = test::graded_sphere(500, 20.0);
  for (const Entity& volume : {inner_volume, outer_volume}) {
    SizeFunction function;
    function.sources = {{2, 1}};
    function.attachments = {volume};
    function.growth_rate = volume == inner_volume ? 1.3 : 1.2;
    function.size_limit = 1.0;
    field.set_sources(field.add(function), {source});
  }
  field.build();
  return field;
}

/// All that a field answers at some points.
struct Answers {
  std::vector<double> one_by_one;
  std::vector<double> exact_one_by_one;
  std::vector<double> together;
  std::vector<double> exact_together;
  std::vector<double> smallest;
  std::vector<double> probed;

  bool operator==(const Answers& other) const {
    return one_by_one == other.one_by_one && exact_one_by_one == other.exact_one_by_one &&
           together == other.together && exact_together == other.exact_together &&
           smallest == other.smallest && probed == other.probed;
  }
};

Answers ask(const SizeField& field, const std::vector<Vec3>& points) {
  Answers answers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Entity& volume = i % 2 == 0 ? inner_volume : outer_volume;
    answers.one_by_one.push_back(field.size(volume, points[i]));
    answers.exact_one_by_one.push_back(field.exact_size(volume, points[i]));
    if (i % 50 == 0) {
      answers.probed.push_back(field.probe(volume, points[i]).size);
      answers.probed.push_back(field.probe(points[i]).size);
    }
  }
  answers.together.resize(points.size());
  answers.exact_together.resize(points.size());
  answers.smallest.resize(points.size());
  field.sizes(outer_volume, points.data(), points.size(), answers.together.data());
  field.exact_sizes(outer_volume, points.data(), points.size(), answers.exact_together.data());
  field.smallest_sizes(points.data(), points.size(), answers.smallest.data());
  return answers;
}

class Evaluation : public testing::TestWithParam<Evaluator> {};

TEST_P(Evaluation, GivesEveryThreadTheSameAnswers) {
  const SizeField field = field_of_two_groups(GetParam());
  test::Random random(1);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < point_count; ++i) {
    points.push_back(test::random_in_box(random, test::cube(i % 3 == 0 ? 4.0 : 1.2)));
  }
  std::array<Answers, test::thread_count> answers;
  test::at_once(
      [&](int thread) { answers[static_cast<std::size_t>(thread)] = ask(field, points); });
  const Answers expected = ask(field, points);
  for (const Answers& own : answers) {
    EXPECT_TRUE(own == expected);
  }
}

TEST_P(Evaluation, MayGoOnWhileAnswersAreCounted) {
  const SizeField field = field_of_two_groups(GetParam());
  test::Random random(2);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < point_count; ++i) {
    points.push_back(test::random_in_box(random, test::cube(2.0)));
  }
  test::at_once([&](int thread) {
    for (const Vec3& p : points) {
      field.size(inner_volume, p);
    }
    if (thread == 0) {
      EXPECT_FALSE(field.summary().empty());
      EXPECT_GT(field.answering_together().size_limit, 0.0);
    }
  });
  std::uint64_t answers = 0;
  for (const SizeField::GroupSummary& group : field.groups()) {
    answers += group.answers;
  }
  EXPECT_EQ(answers, test::thread_count * point_count);
}

INSTANTIATE_TEST_SUITE_P(By, Evaluation, testing::Values(Evaluator::grid, Evaluator::exact),
                         [](const testing::TestParamInfo<Evaluator>& param_info) {
                           return std::string(param_info.param == Evaluator::grid ? "grid"
                                                                                  : "tree");
                         });

}  // namespace
}  // namespace meshgrow
