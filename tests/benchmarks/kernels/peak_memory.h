#ifndef MESHGROW_BENCHMARKS_KERNELS_PEAK_MEMORY_H
#define MESHGROW_BENCHMARKS_KERNELS_PEAK_MEMORY_H

#include <string>

namespace meshgrow::kernels {

/// The work of the child process: makes the input, builds its tree and grid on two threads, and
/// prints the facets, the seconds of building, and the process's peak memory in KiB.
void print_peak_memory(const std::string& input_name);

/// Runs this program as that child; GiB. A process of its own, as nothing else is in its peak.
double peak_gib_of_child(const std::string& input_name);

}  // namespace meshgrow::kernels

#endif
