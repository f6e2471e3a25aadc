#ifndef MESHGROW_STORED_ARRAY_H
#define MESHGROW_STORED_ARRAY_H

#include <cstddef>
#include <memory>
#include <vector>

#include "checked_blocks.h"

namespace meshgrow {

/// An array that never changes: its own, or a part of a mapped file whose blocks are checked when
/// they are first touched; then access throws Error for a damaged one. Copies share their elements.
/// Thread-safe.
template <typename T>
class StoredArray {
 public:
  StoredArray() = default;
  StoredArray(std::vector<T> values)  // NOLINT: what is built becomes what is stored
      : own_(std::make_shared<const std::vector<T>>(std::move(values))),
        data_(own_->data()),
        size_(own_->size()) {}
  /// `blocks` keeps the file mapped.
  StoredArray(const T* data, std::size_t size, std::shared_ptr<const CheckedBlocks> blocks)
      : data_(data), size_(size), blocks_(std::move(blocks)) {}

  const T& operator[](std::size_t i) const {
    if (blocks_) {
      blocks_->touch(i);
    }
    return data_[i];
  }

  /// The elements from `first` to before `end`.
  const T* range(std::size_t first, std::size_t end) const {
    if (blocks_) {
      blocks_->touch(first, end);
    }
    return data_ + first;
  }
  const T* begin() const { return range(0, size_); }
  const T* end() const { return data_ + size_; }

  /// Not checked.
  const T* data() const { return data_; }
  bool is_mapped() const { return blocks_ != nullptr; }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::size_t bytes() const { return size_ * sizeof(T); }

 private:
  std::shared_ptr<const std::vector<T>> own_;
  const T* data_ = nullptr;
  std::size_t size_ = 0;
  std::shared_ptr<const CheckedBlocks> blocks_;
};

}  // namespace meshgrow

#endif
