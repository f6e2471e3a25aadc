#include "whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "error.h"

namespace meshgrow {

namespace fs = std::filesystem;

void write_whole_file(const std::string& path,
                      const std::function<bool(const std::string& unfinished)>& write) {
  const std::string place = place_of_file(path);
  const std::string unfinished = unfinished_name(path);
  const auto fail = [&](const std::string& reason) {
    throw Error("Cannot write " + path + " (" + reason +
                "): choose another file, or make room for it.");
  };
  const std::string blocked = reason_against_file(place);
  if (!blocked.empty()) {
    fail(blocked);
  }
  errno = 0;
  try {
    if (!write(unfinished) || std::rename(unfinished.c_str(), place.c_str()) != 0) {
      fail(errno == 0 ? "for an unknown reason" : std::strerror(errno));
    }
  } catch (...) {
    std::remove(unfinished.c_str());
    throw;
  }
}

std::string unfinished_name(const std::string& path) { return place_of_file(path) + ".unfinished"; }

std::string place_of_file(const std::string& path) {
  std::error_code failed;
  if (!fs::is_symlink(path, failed)) {
    return path;
  }
  const fs::path place = fs::weakly_canonical(path, failed);
  return failed ? path : place.string();
}

std::string reason_against_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || S_ISREG(status.st_mode)) {
    return "";
  }
  return S_ISDIR(status.st_mode) ? "it is a directory" : "it is no ordinary file";
}

bool has_room_behind(const std::string& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  struct stat status {};
  if (file < 0 || ::fstat(file, &status) != 0) {
    return false;
  }
  // More than writers keep back in memory, so that what did not fit does not fit now either.
  constexpr std::size_t more = 1u << 16;
  const std::array<char, 4096> zeros{};
  std::size_t written = 0;
  while (written < more) {
    const ssize_t count = ::write(file, zeros.data(), zeros.size());
    if (count <= 0) {
      break;
    }
    written += static_cast<std::size_t>(count);
  }
  const bool restored = ::ftruncate(file, status.st_size) == 0;
  return ::close(file) == 0 && restored && written >= more;
}

}  // namespace meshgrow
