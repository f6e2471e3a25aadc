#include "peak_memory.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "build_kernels.h"
#include "error.h"
#include "inputs.h"
#include "progress.h"
#include "timing.h"

namespace meshgrow::kernels {

namespace {

/// Peak resident memory of this process, KiB.
long peak_kib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    long kib = 0;
    if (std::sscanf(line.c_str(), "VmHWM: %ld", &kib) == 1) {
      return kib;
    }
  }
  throw Error("/proc/self/status tells no VmHWM: peak memory is measured on Linux only.");
}

[[noreturn]] void become_child(const std::string& input_name, int output) {
  dup2(output, STDOUT_FILENO);
  execl("/proc/self/exe", "kernel_benchmarks", "--peak-of", input_name.c_str(), nullptr);
  _exit(127);
}

}  // namespace

void print_peak_memory(const std::string& input_name) {
  Input input = make_input(input_name);
  const std::size_t facet_count = input.facets.size();
  progress("  child: %.2f GiB at most while the input was made",
           static_cast<double>(peak_kib()) / 1048576.0);
  std::unique_ptr<const BackgroundGrid> grid;
  const double seconds = seconds_of([&] {
    const auto tree = std::make_shared<FacetTree>(std::move(input.facets), 2);
    grid = build_grid(input, tree, 2);
  });
  std::printf("%zu %.3f %ld\n", facet_count, seconds, peak_kib());
}

double peak_gib_of_child(const std::string& input_name) {
  int ends[2];
  if (pipe(ends) != 0) {
    throw Error("No pipe to a child process can be opened.");
  }
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    become_child(input_name, ends[1]);
  }
  close(ends[1]);
  FILE* const output = fdopen(ends[0], "r");
  std::size_t facet_count = 0;
  double seconds = 0.0;
  long kib = 0;
  const int found = std::fscanf(output, "%zu %lf %ld", &facet_count, &seconds, &kib);
  std::fclose(output);
  int status = 0;
  waitpid(child, &status, 0);
  if (child < 0 || found != 3 || status != 0) {
    throw Error("The child process that builds " + input_name + " failed.");
  }
  progress("  child: %zu facets, tree and grid %.2f s on two threads, peak %ld KiB", facet_count,
           seconds, kib);
  return static_cast<double>(kib) / 1048576.0;
}

}  // namespace meshgrow::kernels
