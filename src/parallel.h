#ifndef MESHGROW_PARALLEL_H
#define MESHGROW_PARALLEL_H

#include <omp.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <exception>

namespace meshgrow {

/// As many threads as OMP_NUM_THREADS says, else as there are processors. OpenMP's own default is
/// not asked: Gmsh sets it to 1 for the whole process.
inline int default_threads() {
  const char* wanted = std::getenv("OMP_NUM_THREADS");
  const int count = wanted == nullptr ? 0 : std::atoi(wanted);
  return count > 0 ? count : omp_get_num_procs();
}

/// Runs body(i) for i in [0, count) on `threads` OpenMP threads (0: default_threads()), in any
/// order. The first exception of a body or of `finished` is thrown again after all threads have
/// come to rest. `finished(n)` is called on the calling thread only, with the number of bodies done
/// so far.
template <typename Body, typename Finished>
void parallel_for(std::size_t count, int threads, Body body, Finished finished) {
  std::exception_ptr failure;
  // Relaxed: bodies need not see what others did, and no order among them shall hide from a checker
  // of races that they have none.
  std::atomic<bool> failed{false};
  std::atomic<std::size_t> done{0};
  const int team = threads > 0 ? threads : default_threads();
#pragma omp parallel for schedule(dynamic, 1) num_threads(team)
  for (std::size_t i = 0; i < count; ++i) {
    if (failed.load(std::memory_order_relaxed)) {
      continue;
    }
    try {
      body(i);
      const std::size_t so_far = done.fetch_add(1, std::memory_order_relaxed) + 1;
      if (omp_get_thread_num() == 0) {
        finished(so_far);
      }
    } catch (...) {
#pragma omp critical(meshgrow_parallel_for)
      if (!failure) {
        failure = std::current_exception();
      }
      failed.store(true, std::memory_order_relaxed);
    }
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
}

template <typename Body>
void parallel_for(std::size_t count, int threads, Body body) {
  parallel_for(count, threads, body, [](std::size_t) {});
}

}  // namespace meshgrow

#endif
