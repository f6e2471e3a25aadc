#ifndef MESHGROW_CHECKED_BLOCKS_H
#define MESHGROW_CHECKED_BLOCKS_H

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace meshgrow {

/// 64-bit XXH3 of the bytes.
std::uint64_t checksum(const void* bytes, std::size_t count);

/// So many elements of this size make a block of an array, as a power of two: about 64 KiB.
unsigned block_shift(std::size_t element_bytes);

/// The checksums of an array's blocks.
std::vector<std::uint64_t> block_checksums(const void* data, std::size_t count,
                                           std::size_t element_bytes);

/// Checks the blocks of an array in a mapped file, each when it is first touched.
///
/// Thread-safe: threads that touch a block for the first time together check it both.
class CheckedBlocks {
 public:
  struct Array {
    const char* data = nullptr;
    std::size_t count = 0;
    std::size_t element_bytes = 0;
    std::string name;  ///< of file and array, as the error names it
  };

  /// `is_sound(first, end)` tells whether elements say nothing impossible, such as an index beyond
  /// another array.
  CheckedBlocks(Array array, std::vector<std::uint64_t> checksums,
                std::function<bool(std::size_t first, std::size_t end)> is_sound);

  /// Throws Error if the element's block is not as it was written.
  void touch(std::size_t element) const {
    const std::size_t block = element >> shift_;
    if (!is_checked_[block].load(std::memory_order_relaxed)) {
      check(block);
    }
  }

  /// The same for all elements from `first` to before `end`.
  void touch(std::size_t first, std::size_t end) const;

 private:
  void check(std::size_t block) const;

  Array array_;
  unsigned shift_;
  std::vector<std::uint64_t> checksums_;
  std::function<bool(std::size_t, std::size_t)> is_sound_;
  std::unique_ptr<std::atomic<bool>[]> is_checked_;
};

}  // namespace meshgrow

#endif
