#ifndef MESHGROW_MAPPED_FILE_H
#define MESHGROW_MAPPED_FILE_H

#include <cstddef>
#include <string>

namespace meshgrow {

/// A file in memory, read as it is touched; processes that map the same one share it.
class MappedFile {
 public:
  /// Throws Error if the file cannot be read.
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  const char* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace meshgrow

#endif
