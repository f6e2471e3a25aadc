#ifndef MESHGROW_TESTS_TEST_WITH_FOLDER_H
#define MESHGROW_TESTS_TEST_WITH_FOLDER_H

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace meshgrow::test {

/// A test with a folder of its own, which is gone at the end.
class TestWithFolder : public testing::Test {
 protected:
  TestWithFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "meshgrow_testXXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~TestWithFolder() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::filesystem::path folder_;
};

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace meshgrow::test

#endif
