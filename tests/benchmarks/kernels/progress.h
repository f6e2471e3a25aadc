#ifndef MESHGROW_BENCHMARKS_KERNELS_PROGRESS_H
#define MESHGROW_BENCHMARKS_KERNELS_PROGRESS_H

#include <cstdio>

namespace meshgrow::kernels {

/// One line on stderr, like printf.
template <typename... Values>
void progress(const char* format, Values... values) {
  std::fprintf(stderr, format, values...);
  std::fputc('\n', stderr);
}

inline void progress(const char* line) { std::fprintf(stderr, "%s\n", line); }

}  // namespace meshgrow::kernels

#endif
