// Limits of memory that containers and jobs have.

#include "control_groups.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace meshgrow {
namespace {

namespace fs = std::filesystem;

constexpr unsigned long long unlimited = std::numeric_limits<unsigned long long>::max();

/// A folder like /sys/fs/cgroup, and a list like /proc/self/cgroup.
class ControlGroups : public testing::Test {
 protected:
  ControlGroups() {
    std::string name = (fs::temp_directory_path() / "groupsXXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~ControlGroups() override { fs::remove_all(folder_); }

  void write(const std::string& file, const std::string& text) const {
    fs::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file) << text << "\n";
  }
  unsigned long long left() const {
    return left_in_control_groups((folder_ / "list").string(), (folder_ / "sys").string());
  }

  fs::path folder_;
};

TEST_F(ControlGroups, LimitNothingWhereThereAreNone) { EXPECT_EQ(left(), unlimited); }

TEST_F(ControlGroups, LimitNothingAtTheirMost) {
  write("list", "0::/");
  write("sys/memory.max", "max");
  write("sys/memory.current", "1000");
  EXPECT_EQ(left(), unlimited);
}

TEST_F(ControlGroups, OfAContainerAreTheOutermostItSees) {
  write("list", "0::/of/the/host");
  write("sys/memory.max", "5000");
  write("sys/memory.current", "3000");
  write("sys/memory.stat", "anon 2000\nfile 1000\ninactive_anon 7\ninactive_file 600");
  EXPECT_EQ(left(), 5000u - (3000u - 600u));
}

TEST_F(ControlGroups, AroundTheOwnOneCountToo) {
  write("list", "0::/jobs/12/step");
  write("sys/jobs/memory.max", "max");
  write("sys/jobs/12/memory.max", "9000");
  write("sys/jobs/12/memory.current", "8000");
  write("sys/jobs/12/step/memory.max", "7000");
  write("sys/jobs/12/step/memory.current", "100");
  EXPECT_EQ(left(), 1000u);
  write("sys/jobs/12/memory.max", "max");
  EXPECT_EQ(left(), 6900u);
}

TEST_F(ControlGroups, OfVersion1AreThoseOfMemory) {
  write("list", "5:cpu,cpuacct:/other\n4:memory:/job\n0::/");
  write("sys/memory/memory.limit_in_bytes", "9223372036854771712");
  write("sys/memory/memory.usage_in_bytes", "5000");
  write("sys/memory/job/memory.limit_in_bytes", "4000");
  write("sys/memory/job/memory.usage_in_bytes", "3000");
  write("sys/memory/job/memory.stat", "inactive_file 1\ntotal_inactive_file 500");
  write("sys/memory/other/memory.limit_in_bytes", "1");
  write("sys/memory/other/memory.usage_in_bytes", "1");
  EXPECT_EQ(left(), 1500u);
}

TEST_F(ControlGroups, ThatAreOverfullLeaveNothing) {
  write("sys/memory.max", "1000");
  write("sys/memory.current", "2000");
  EXPECT_EQ(left(), 0u);
}

}  // namespace
}  // namespace meshgrow
