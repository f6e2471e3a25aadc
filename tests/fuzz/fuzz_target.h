#ifndef MESHGROW_TESTS_FUZZ_TARGET_H
#define MESHGROW_TESTS_FUZZ_TARGET_H

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

/// What libFuzzer, or the driver in replay.cpp, calls with one input. Whatever the bytes are, it
/// returns 0; what must not happen ends the process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace meshgrow::fuzz {

/// Ends the process, with a sentence about what is wrong with the input's result, unless it holds.
inline void require(bool holds, const char* sentence) {
  if (!holds) {
    std::fprintf(stderr, "Does not hold: %s\n", sentence);
    std::abort();
  }
}

}  // namespace meshgrow::fuzz

#endif
