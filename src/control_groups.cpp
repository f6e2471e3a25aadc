#include "control_groups.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <vector>

namespace meshgrow {

namespace {

using Bytes = unsigned long long;

constexpr Bytes unlimited = std::numeric_limits<Bytes>::max();

struct Names {
  const char* controller;  ///< in the list; version 2 has no name there
  const char* folder;
  const char* limit;
  const char* used;
  const char* cache;  ///< in the statistics
};

constexpr Names versions[] = {
    {"memory", "/memory", "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"},
    {"", "", "memory.max", "memory.current", "inactive_file"}};

/// From outermost to own. A container may see its own as the outermost, and none below it.
std::vector<std::string> groups_in(const std::string& list, const std::string& controller) {
  std::vector<std::string> groups{""};
  std::ifstream file(list);  // lines "number:controller:/path"
  for (std::string line; std::getline(file, line);) {
    const std::size_t name = line.find(':') + 1;
    const std::size_t path = line.find(':', name) + 1;
    if (name == 0 || path == 0 || line.substr(name, path - 1 - name) != controller ||
        path + 1 >= line.size()) {
      continue;
    }
    for (std::size_t end = path; end != std::string::npos;) {
      end = line.find('/', end + 1);
      groups.push_back(line.substr(path, end - path));
    }
  }
  return groups;
}

Bytes left_in(const std::string& folder, const Names& names) {
  const std::optional<Bytes> limit = number_in_file(folder + names.limit);
  const std::optional<Bytes> used = number_in_file(folder + names.used);
  if (!limit || !used) {
    return unlimited;
  }
  const Bytes cache = number_in_file(folder + "memory.stat", names.cache).value_or(0);
  const Bytes kept = *used - std::min(*used, cache);
  return *limit - std::min(*limit, kept);
}

}  // namespace

unsigned long long left_in_control_groups(const std::string& list, const std::string& folder) {
  Bytes least = unlimited;
  for (const Names& names : versions) {
    for (const std::string& group : groups_in(list, names.controller)) {
      least = std::min(least, left_in(folder + names.folder + group + "/", names));
    }
  }
  return least;
}

std::optional<unsigned long long> number_in_file(const std::string& path, const std::string& name) {
  std::ifstream file(path);
  for (std::string word; !name.empty() && file >> word && word != name;) {
  }
  Bytes number = 0;
  return file >> number ? std::optional<Bytes>(number) : std::nullopt;
}

}  // namespace meshgrow
