#include "grid_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "memory_latency.h"
#include "progress.h"
#include "queries.h"
#include "space_filling_curve.h"
#include "timing.h"

namespace meshgrow::kernels {

namespace {

constexpr double allowed_error_of_batch = 1e-6;

bool wants_quality(const Options& options) {
  return options.wants_any({"grid.max_over", "grid.p999_under"});
}

bool wants_evaluation(const Options& options) {
  return options.wants_any({"grid.eval.ns", "grid.eval.random_vs_latency",
                            "grid.eval.dependent_vs_latency", "grid.eval.batch_vs_single"});
}

/// Prints only the worst answer: where one cell is wrong, thousands of points are.
void fail_if_above(double allowed, double worst_error, const Checks::Answer& worst,
                   const Input& input, Checks& checks) {
  if (!(worst_error <= allowed)) {
    checks.fail(input, worst);
  }
}

/// a > b, where NaN is above everything.
bool above(double a, double b) { return !(a <= b); }

void measure_quality(const Input& input, const BackgroundGrid& grid, const Options& options,
                     Results& results, Checks& checks) {
  progress("  grid against exact sizes at %zu points", options.sample_count);
  double most_over = -1.0;
  double most_different = -1.0;
  Checks::Answer worst_over{};
  Checks::Answer worst_batch{};
  std::vector<double> under;
  under.reserve(options.sample_count);
  for (const Place place : {Place::volume, Place::near}) {
    const std::vector<Vec3> points = along_curve(
        random_points(input, place, options.sample_count / 2, query_seed), input.query_box);
    std::vector<double> batch(points.size());
    grid.sizes(points.data(), points.size(), batch.data());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double exact = grid.tree().size(points[i], size_limit);
      const double single = grid.size(points[i]);
      const double over = single / exact - 1.0;
      if (above(over, most_over)) {
        most_over = over;
        worst_over = {"grid.size above (1 + t) times the exact size", query_seed, points[i], single,
                      exact};
      }
      const Checks::Answer answer{"grid.sizes against grid.size", query_seed, points[i], batch[i],
                                  single};
      if (above(answer.relative_error(), most_different)) {
        most_different = answer.relative_error();
        worst_batch = answer;
      }
      under.push_back(std::max(0.0, exact / single - 1.0));
    }
  }
  fail_if_above(tolerance, most_over, worst_over, input, checks);
  fail_if_above(allowed_error_of_batch, most_different, worst_batch, input, checks);
  if (options.wants("grid.max_over")) {
    results.add({"grid.max_over", input.name}, most_over);
  }
  if (options.wants("grid.p999_under")) {
    const auto rank = under.begin() + static_cast<std::ptrdiff_t>(under.size() * 999 / 1000);
    std::nth_element(under.begin(), rank, under.end());
    results.add({"grid.p999_under", input.name}, *rank);
  }
}

class Evaluation {
 public:
  Evaluation(const Input& input, const BackgroundGrid& grid, const Options& options,
             Results& results)
      : input_(input),
        grid_(grid),
        options_(options),
        results_(results),
        latency_(grid.statistics().bytes, query_seed),
        answers_(options.eval_count) {}

  void measure() {
    measure_volume();
    measure_near();
    if (options_.wants("grid.eval.ns")) {
      measure_along_curve(Place::volume);
      measure_along_curve(Place::near);
    }
  }

 private:
  void measure_volume() {
    const Queries for_single = queries(Place::volume, Order::random);
    const Queries for_batch = queries(Place::volume, Order::random);
    const Queries for_dependent = queries(Place::volume, Order::random);
    double single = 0.0;
    double batch = 0.0;
    double reads = 0.0;
    double dependent = 0.0;
    for (std::size_t part = 0; part < parts; ++part) {
      single += single_seconds(for_single, part);
      reads += latency_.seconds_of_reads(options_.eval_count / parts);
      batch += batch_seconds(for_batch, part);
      dependent += dependent_seconds(for_dependent, part);
    }
    add({"grid.eval.random_vs_latency", input_.name}, single / reads);
    add({"grid.eval.dependent_vs_latency", input_.name}, dependent / reads);
    add({"grid.eval.batch_vs_single", input_.name, "volume"}, batch / single);
    add_nanoseconds(Place::volume, Order::random, single);
  }

  void measure_near() {
    const Queries for_single = queries(Place::near, Order::random);
    const Queries for_batch = queries(Place::near, Order::random);
    double single = 0.0;
    double batch = 0.0;
    for (std::size_t part = 0; part < parts; ++part) {
      single += single_seconds(for_single, part);
      batch += batch_seconds(for_batch, part);
    }
    add({"grid.eval.batch_vs_single", input_.name, "near"}, batch / single);
    add_nanoseconds(Place::near, Order::random, single);
  }

  void measure_along_curve(Place place) {
    const Queries sorted = queries(place, Order::curve);
    double single = 0.0;
    for (std::size_t part = 0; part < parts; ++part) {
      single += single_seconds(sorted, part);
    }
    add_nanoseconds(place, Order::curve, single);
  }

  /// Points that were never asked for before. As many to warm up: a small grid is in the cache
  /// wholly, as it is after a while of steady use.
  Queries queries(Place place, Order order) {
    return make_queries(input_, place, order, options_.eval_count, options_.eval_count, set_++);
  }

  /// The plain loop of a user, whose evaluations may overlap.
  double single_seconds(const Queries& queries, std::size_t part) {
    return warm_seconds_of(queries, part, [this](const Vec3* points, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) {
        answers_[i] = grid_.size(points[i]);
      }
    });
  }

  double batch_seconds(const Queries& queries, std::size_t part) {
    return warm_seconds_of(queries, part, [this](const Vec3* points, std::size_t count) {
      grid_.sizes(points, count, answers_.data());
    });
  }

  /// Each evaluation waits for the one before, as a pointer chase does: which point is next depends
  /// on the sign bit of the last size, which is never set.
  double dependent_seconds(const Queries& queries, std::size_t part) const {
    return warm_seconds_of(queries, part, [this](const Vec3* points, std::size_t count) {
      for (std::size_t i = 0; i < count;) {
        const double size = grid_.size(points[i]);
        std::uint64_t bits = 0;
        std::memcpy(&bits, &size, sizeof bits);
        i += 1 + (bits >> 63);
      }
    });
  }

  void add_nanoseconds(Place place, Order order, double seconds) {
    add({"grid.eval.ns", input_.name, text(place), text(order)},
        1e9 * seconds / static_cast<double>(options_.eval_count));
  }

  void add(const Path& path, double value) {
    if (options_.wants(path.front())) {
      results_.add(path, value);
    }
  }

  const Input& input_;
  const BackgroundGrid& grid_;
  const Options& options_;
  Results& results_;
  MemoryLatency latency_;
  unsigned set_ = 0;
  std::vector<double> answers_;
};

}  // namespace

bool wants_grid_kernels(const Options& options) {
  return wants_quality(options) || wants_evaluation(options);
}

void measure_grid_kernels(const Input& input, const BackgroundGrid& grid, const Options& options,
                          Results& results, Checks& checks) {
  // Also where only times are wanted: of a wrong grid they say nothing.
  measure_quality(input, grid, options, results, checks);
  if (!wants_evaluation(options)) {
    return;
  }
  Evaluation evaluation(input, grid, options, results);
  for (int repetition = 0; repetition < options.repetitions; ++repetition) {
    progress("  grid evaluation, repetition %d", repetition + 1);
    evaluation.measure();
  }
}

}  // namespace meshgrow::kernels
