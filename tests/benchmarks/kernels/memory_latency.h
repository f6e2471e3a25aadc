#ifndef MESHGROW_BENCHMARKS_KERNELS_MEMORY_LATENCY_H
#define MESHGROW_BENCHMARKS_KERNELS_MEMORY_LATENCY_H

#include <cstddef>
#include <cstdint>
#include <vector>

namespace meshgrow::kernels {

/// Dependent random reads in a buffer: each cache line says which one is read next, on one cycle
/// through all of them. Memory from the same allocator as the grid's, so with pages of the same
/// size.
class MemoryLatency {
 public:
  MemoryLatency(std::size_t bytes, unsigned seed);

  /// Seconds of so many reads, after some to have in the caches what steady reading leaves there.
  /// Reads on from where the last call ended.
  double seconds_of_reads(std::size_t reads);

 private:
  void read(std::size_t reads);

  struct alignas(64) CacheLine {
    std::uint32_t next = 0;
  };

  std::vector<CacheLine> lines_;
  std::uint32_t current_ = 0;
};

}  // namespace meshgrow::kernels

#endif
