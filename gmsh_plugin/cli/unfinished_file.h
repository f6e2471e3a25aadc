#ifndef MESHGROW_CLI_UNFINISHED_FILE_H
#define MESHGROW_CLI_UNFINISHED_FILE_H

#include <filesystem>
#include <string>

namespace meshgrow::cli {

/// Where a file is written until it is complete: hidden, beside its later place. Removed at the end
/// of this object's life, and when the program is interrupted, unless it was finished.
class UnfinishedFile {
 public:
  /// `ending`: of the name meanwhile; it tells Gmsh the format.
  UnfinishedFile(const std::filesystem::path& place, const std::string& ending);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Moves it to its place, over an older file. Throws Error if that fails.
  void finish();

 private:
  std::filesystem::path place_;
  std::filesystem::path path_;
};

}  // namespace meshgrow::cli

#endif
