#include "available_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>

#include "control_groups.h"

namespace meshgrow {

namespace {

using Bytes = unsigned long long;

constexpr Bytes nothing_told = 1ull << 30;

/// Of the process itself, where somebody has set limits; used memory is told in pages.
Bytes left_to_process() {
  constexpr int data_column = 5;
  const long page = sysconf(_SC_PAGESIZE);
  std::ifstream file("/proc/self/statm");
  Bytes whole = 0;
  Bytes data = 0;
  if (file >> whole) {
    for (int column = 1; column <= data_column; ++column) {
      file >> data;
    }
  }
  const auto under = [page](auto resource, Bytes pages) {
    rlimit limit = {};
    if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
      return std::numeric_limits<Bytes>::max();
    }
    return limit.rlim_cur - std::min<Bytes>(limit.rlim_cur, pages * static_cast<Bytes>(page));
  };
  return std::min(under(RLIMIT_AS, whole), under(RLIMIT_DATA, data));
}

Bytes left_in_system() {
  if (const std::optional<Bytes> kilobytes = number_in_file("/proc/meminfo", "MemAvailable:")) {
    return *kilobytes * 1024;
  }
  const long pages = sysconf(_SC_PHYS_PAGES);
  const long page = sysconf(_SC_PAGESIZE);
  return pages > 0 && page > 0 ? static_cast<Bytes>(pages) * static_cast<Bytes>(page) / 2
                               : nothing_told;
}

}  // namespace

std::size_t available_memory() {
  // Where addresses have 32 bits, the system may have more than a process can ever take.
  constexpr Bytes most = std::numeric_limits<std::size_t>::max();
  return static_cast<std::size_t>(
      std::min({most, left_in_system(), left_in_control_groups(), left_to_process()}));
}

}  // namespace meshgrow
