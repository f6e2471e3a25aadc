#ifndef MESHGROW_TESTS_FUZZ_MENDED_FIELD_H
#define MESHGROW_TESTS_FUZZ_MENDED_FIELD_H

#include <cstddef>
#include <cstdint>

namespace meshgrow::fuzz {

/// Where the directory of a saved field (field_file.h) begins; `size` if that is told wrong.
std::size_t directory_of(const std::uint8_t* file, std::size_t size);

/// Makes all checksums and lengths of a saved field right again after its bytes were changed, so
/// that what they say is looked at. Does nothing to what is shorter than a header.
void mend_field(std::uint8_t* file, std::size_t size);

}  // namespace meshgrow::fuzz

#endif
