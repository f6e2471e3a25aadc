#include "checked_blocks.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>

#include "error.h"

namespace meshgrow {

std::uint64_t checksum(const void* bytes, std::size_t count) { return XXH3_64bits(bytes, count); }

unsigned block_shift(std::size_t element_bytes) {
  constexpr std::size_t block_bytes = 1 << 16;
  unsigned shift = 0;
  while ((element_bytes << (shift + 1)) <= block_bytes) {
    ++shift;
  }
  return shift;
}

std::vector<std::uint64_t> block_checksums(const void* data, std::size_t count,
                                           std::size_t element_bytes) {
  const std::size_t per_block = std::size_t{1} << block_shift(element_bytes);
  std::vector<std::uint64_t> result;
  for (std::size_t first = 0; first < count; first += per_block) {
    result.push_back(checksum(static_cast<const char*>(data) + first * element_bytes,
                              std::min(per_block, count - first) * element_bytes));
  }
  return result;
}

CheckedBlocks::CheckedBlocks(Array array, std::vector<std::uint64_t> checksums,
                             std::function<bool(std::size_t, std::size_t)> is_sound)
    : array_(std::move(array)),
      shift_(block_shift(array_.element_bytes)),
      checksums_(std::move(checksums)),
      is_sound_(std::move(is_sound)),
      is_checked_(new std::atomic<bool>[checksums_.size()]()) {}

void CheckedBlocks::touch(std::size_t first, std::size_t end) const {
  if (first < end) {
    for (std::size_t block = first >> shift_; block <= (end - 1) >> shift_; ++block) {
      touch(block << shift_);
    }
  }
}

void CheckedBlocks::check(std::size_t block) const {
  const std::size_t first = block << shift_;
  const std::size_t end = std::min(array_.count, first + (std::size_t{1} << shift_));
  if (checksum(array_.data + first * array_.element_bytes, (end - first) * array_.element_bytes) !=
          checksums_[block] ||
      !is_sound_(first, end)) {
    throw Error(array_.name + " is damaged at block " + std::to_string(block) +
                ": save the field again.");
  }
  is_checked_[block].store(true, std::memory_order_relaxed);
}

}  // namespace meshgrow
