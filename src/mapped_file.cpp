#include "mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "error.h"

namespace meshgrow {

MappedFile::MappedFile(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status = {};
  int problem = file < 0 || fstat(file, &status) != 0 ? errno : 0;
  if (problem == 0 && S_ISDIR(status.st_mode)) {
    problem = EISDIR;
  }
  if (problem == 0 && status.st_size > 0) {
    size_ = static_cast<std::size_t>(status.st_size);
    void* mapped = mmap(nullptr, size_, PROT_READ, MAP_SHARED, file, 0);
    problem = mapped == MAP_FAILED ? errno : 0;
    data_ = problem == 0 ? static_cast<const char*>(mapped) : nullptr;
  }
  if (file >= 0) {
    close(file);
  }
  if (problem != 0) {
    throw Error("Cannot read " + path + " (" + std::strerror(problem) +
                "): give a file that meshgrow saved.");
  }
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) {
    munmap(const_cast<char*>(data_), size_);
  }
}

}  // namespace meshgrow
