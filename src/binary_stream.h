#ifndef MESHGROW_BINARY_STREAM_H
#define MESHGROW_BINARY_STREAM_H

#include <cstdint>
#include <ostream>

namespace meshgrow {

constexpr bool is_little_endian =
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    false;
#else
    true;
#endif

/// The bytes of a number as they are in memory.
template <typename T>
void write_binary(std::ostream& file, const T& value) {
  file.write(reinterpret_cast<const char*>(&value), sizeof(T));
}

}  // namespace meshgrow

#endif
