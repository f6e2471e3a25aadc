// Tells libFuzzer how to change a saved field so that it is still one: most often a piece of it,
// with all checksums made good.

#include <algorithm>
#include <cstring>
#include <random>
#include <vector>

#include "fuzz_target.h"
#include "mended_field.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t room);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t room, unsigned seed);

namespace {

/// Changes some bytes from `first` to before `end` in their places.
void change_in_place(std::uint8_t* data, std::size_t first, std::size_t end,
                     std::minstd_rand& random) {
  if (first >= end) {
    return;
  }
  constexpr std::size_t longest = 64;
  const std::size_t begin = first + random() % (end - first);
  const std::size_t length = std::min<std::size_t>(1 + random() % longest, end - begin);
  std::vector<std::uint8_t> piece(data + begin, data + begin + length);
  const std::size_t changed = LLVMFuzzerMutate(piece.data(), length, length);
  std::copy(piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(changed), data + begin);
}

}  // namespace

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room,
                                    unsigned seed) {
  std::minstd_rand random(seed);
  const std::size_t directory = meshgrow::fuzz::directory_of(data, size);
  const unsigned what = random() % 16;
  if (what == 0 || size < 64) {
    return LLVMFuzzerMutate(data, size, room);  // checksums and all
  }
  if (what < 6) {
    change_in_place(data, directory, size, random);
  } else if (what < 9 && directory < size) {
    // The directory is the end of the file, so it may become longer or shorter.
    size = directory + LLVMFuzzerMutate(data + directory, size - directory, room - directory);
  } else {
    change_in_place(data, 64, directory, random);
  }
  meshgrow::fuzz::mend_field(data, size);
  return size;
}
