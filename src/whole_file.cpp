#include "whole_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "error.h"

namespace meshgrow {

void write_whole_file(const std::string& path,
                      const std::function<bool(const std::string& unfinished)>& write) {
  const std::string unfinished = path + ".unfinished";
  const auto fail = [&](int problem) {
    throw Error("Cannot write " + path + " (" + std::strerror(problem) +
                "): choose another file, or make room for it.");
  };
  if (std::filesystem::is_directory(path)) {
    fail(EISDIR);
  }
  errno = 0;
  try {
    if (!write(unfinished) || std::rename(unfinished.c_str(), path.c_str()) != 0) {
      fail(errno);
    }
  } catch (...) {
    std::remove(unfinished.c_str());
    throw;
  }
}

}  // namespace meshgrow
