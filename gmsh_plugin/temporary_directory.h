#ifndef MESHGROW_TEMPORARY_DIRECTORY_H
#define MESHGROW_TEMPORARY_DIRECTORY_H

#include <filesystem>

namespace meshgrow {

/// A new directory, gone with all that is in it at the end of this object's life.
class TemporaryDirectory {
 public:
  /// Throws Error if none can be made.
  TemporaryDirectory();
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace meshgrow

#endif
