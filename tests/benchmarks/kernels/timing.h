#ifndef MESHGROW_BENCHMARKS_KERNELS_TIMING_H
#define MESHGROW_BENCHMARKS_KERNELS_TIMING_H

#include <benchmark/benchmark.h>

#include <chrono>

#include "queries.h"

namespace meshgrow::kernels {

/// Wall time of one call.
///
/// Google Benchmark runs all iterations of one kernel before it turns to the next one. On a machine
/// that others use as well, what is compared must alternate within one repetition (A B A B ...), so
/// that both sides meet the same neighbours, and ratios are made repetition by repetition. So only
/// its guards against the optimizer are used here, and the loops are our own.
template <typename Work>
double seconds_of(Work work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  benchmark::ClobberMemory();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Wall time of `ask(points, count)` on one of the parts of the queries' points, after it was asked
/// the same part of the ones to warm up.
template <typename Ask>
double warm_seconds_of(const Queries& queries, std::size_t part, Ask ask) {
  const auto ask_part_of = [&](const std::vector<Vec3>& points) {
    const std::size_t first = part * points.size() / parts;
    ask(points.data() + first, (part + 1) * points.size() / parts - first);
  };
  ask_part_of(queries.warm_up);
  return seconds_of([&] { ask_part_of(queries.points); });
}

}  // namespace meshgrow::kernels

#endif
