#include "memory_latency.h"

#include <algorithm>
#include <random>
#include <utility>

#include "timing.h"

namespace meshgrow::kernels {

MemoryLatency::MemoryLatency(std::size_t bytes, unsigned seed)
    : lines_(std::max<std::size_t>(2, bytes / sizeof(CacheLine))) {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    lines_[i].next = static_cast<std::uint32_t>(i);
  }
  // Sattolo's shuffle leaves one single cycle.
  std::mt19937_64 random(seed);
  for (std::size_t i = lines_.size() - 1; i > 0; --i) {
    const std::size_t other = std::uniform_int_distribution<std::size_t>(0, i - 1)(random);
    std::swap(lines_[i].next, lines_[other].next);
  }
}

void MemoryLatency::read(std::size_t reads) {
  std::uint32_t current = current_;
  for (std::size_t i = 0; i < reads; ++i) {
    current = lines_[current].next;
  }
  current_ = current;
  benchmark::DoNotOptimize(current_);
}

double MemoryLatency::seconds_of_reads(std::size_t reads) {
  // A buffer that may fit in a cache must be in it as a whole.
  constexpr std::size_t lines_of_large_cache = 1000000;
  read(lines_.size() <= lines_of_large_cache ? lines_.size() : reads);
  return seconds_of([&] { read(reads); });
}

}  // namespace meshgrow::kernels
