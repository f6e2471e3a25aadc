#include "available_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace meshgrow {

namespace {

using Bytes = unsigned long long;

constexpr Bytes nothing_told = 1ull << 30;

/// The number behind `name` in a file of "name: number" or "name number" lines; without a name, the
/// number with which the file begins. None if it is not there: "max" is no number.
std::optional<Bytes> number_in(const char* path, const std::string& name = "") {
  std::ifstream file(path);
  for (std::string word; !name.empty() && file >> word && word != name;) {
  }
  Bytes number = 0;
  return file >> number ? std::optional<Bytes>(number) : std::nullopt;
}

Bytes left(std::optional<Bytes> limit, std::optional<Bytes> used) {
  if (!limit || !used) {
    return std::numeric_limits<Bytes>::max();
  }
  return *limit - std::min(*limit, *used);
}

/// Of the control group that a container is: caches in it can be dropped.
Bytes left_in_group() {
  const std::optional<Bytes> cache = number_in("/sys/fs/cgroup/memory.stat", "inactive_file");
  std::optional<Bytes> used = number_in("/sys/fs/cgroup/memory.current");
  if (used && cache) {
    *used -= std::min(*used, *cache);
  }
  return std::min(left(number_in("/sys/fs/cgroup/memory.max"), used),
                  left(number_in("/sys/fs/cgroup/memory/memory.limit_in_bytes"),
                       number_in("/sys/fs/cgroup/memory/memory.usage_in_bytes")));
}

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
  const auto under = [page](int resource, Bytes pages) {
    rlimit limit = {};
    if (getrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0 ||
        limit.rlim_cur == RLIM_INFINITY) {
      return std::numeric_limits<Bytes>::max();
    }
    return left(limit.rlim_cur, pages * static_cast<Bytes>(page));
  };
  return std::min(under(RLIMIT_AS, whole), under(RLIMIT_DATA, data));
}

Bytes left_in_system() {
  if (const std::optional<Bytes> kilobytes = number_in("/proc/meminfo", "MemAvailable:")) {
    return *kilobytes * 1024;
  }
  const long pages = sysconf(_SC_PHYS_PAGES);
  const long page = sysconf(_SC_PAGESIZE);
  return pages > 0 && page > 0 ? static_cast<Bytes>(pages) * static_cast<Bytes>(page) / 2
                               : nothing_told;
}

}  // namespace

std::size_t available_memory() {
  return static_cast<std::size_t>(std::min({left_in_system(), left_in_group(), left_to_process()}));
}

}  // namespace meshgrow
