#ifndef MESHGROW_GMSH_MEMORY_H
#define MESHGROW_GMSH_MEMORY_H

#include <cstddef>
#include <string>
#include <vector>

#include "gmsh_library.h"

namespace meshgrow::gmsh {

inline GmshLibrary& library() { return GmshLibrary::instance(); }

/// An array that Gmsh allocates and the caller frees.
template <typename T>
class GmshArray {
 public:
  GmshArray() = default;
  GmshArray(const GmshArray&) = delete;
  GmshArray& operator=(const GmshArray&) = delete;
  ~GmshArray() { library().free(data_); }

  T** data() { return &data_; }
  std::size_t* size() { return &size_; }
  std::vector<T> copy() const { return std::vector<T>(data_, data_ + size_); }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// An array of arrays that Gmsh allocates.
template <typename T>
class GmshArrays {
 public:
  GmshArrays() = default;
  GmshArrays(const GmshArrays&) = delete;
  GmshArrays& operator=(const GmshArrays&) = delete;
  ~GmshArrays() {
    for (std::size_t i = 0; i < count_; ++i) {
      library().free(data_[i]);
    }
    library().free(data_);
    library().free(sizes_);
  }

  T*** data() { return &data_; }
  std::size_t** sizes() { return &sizes_; }
  std::size_t* count() { return &count_; }
  std::vector<T> copy(std::size_t i) const {
    return std::vector<T>(data_[i], data_[i] + sizes_[i]);
  }

 private:
  T** data_ = nullptr;
  std::size_t* sizes_ = nullptr;
  std::size_t count_ = 0;
};

/// A text that Gmsh allocates.
class GmshString {
 public:
  GmshString() = default;
  GmshString(const GmshString&) = delete;
  GmshString& operator=(const GmshString&) = delete;
  ~GmshString() { library().free(text_); }

  char** data() { return &text_; }
  std::string copy() const { return text_ == nullptr ? "" : text_; }

 private:
  char* text_ = nullptr;
};

/// Texts that Gmsh allocates, and the array of them.
class GmshStrings {
 public:
  GmshStrings() = default;
  GmshStrings(const GmshStrings&) = delete;
  GmshStrings& operator=(const GmshStrings&) = delete;
  ~GmshStrings() {
    for (std::size_t i = 0; i < size_; ++i) {
      library().free(data_[i]);
    }
    library().free(data_);
  }

  char*** data() { return &data_; }
  std::size_t* size() { return &size_; }
  std::vector<std::string> copy() const { return std::vector<std::string>(data_, data_ + size_); }

 private:
  char** data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace meshgrow::gmsh

#endif
