#ifndef MESHGROW_PARALLEL_H
#define MESHGROW_PARALLEL_H

#include <omp.h>

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
  std::size_t done = 0;
  const int team = threads > 0 ? threads : default_threads();
#pragma omp parallel for schedule(dynamic, 1) num_threads(team)
  for (std::size_t i = 0; i < count; ++i) {
    bool failed = false;
#pragma omp critical(meshgrow_parallel_for)
    failed = failure != nullptr;
    if (failed) {
      continue;
    }
    try {
      body(i);
      std::size_t so_far = 0;
#pragma omp atomic capture
      so_far = ++done;
      if (omp_get_thread_num() == 0) {
        finished(so_far);
      }
    } catch (...) {
#pragma omp critical(meshgrow_parallel_for)
      if (!failure) {
        failure = std::current_exception();
      }
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
