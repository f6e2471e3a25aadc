#ifndef MESHGROW_CONTROL_GROUPS_H
#define MESHGROW_CONTROL_GROUPS_H

#include <optional>
#include <string>

namespace meshgrow {

/// Bytes that the control groups of this process still allow, those around its own included: of a
/// container, or of a job on a cluster. Caches in them count as free, since they can be dropped.
/// The largest number there is where nothing is limited. `list` names the groups of the process,
/// `folder` holds them, of version 1 or 2. Thread-safe.
unsigned long long left_in_control_groups(const std::string& list = "/proc/self/cgroup",
                                          const std::string& folder = "/sys/fs/cgroup");

/// The number behind `name` in a file of "name: number" or "name number" lines; without a name, the
/// number with which the file begins. None if it is not there: "max" is no number. Thread-safe.
std::optional<unsigned long long> number_in_file(const std::string& path,
                                                 const std::string& name = "");

}  // namespace meshgrow

#endif
