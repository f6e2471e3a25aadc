#ifndef MESHGROW_BYTE_STREAM_H
#define MESHGROW_BYTE_STREAM_H

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

#include "error.h"

namespace meshgrow {

// Numbers and texts one after the other, as of field_file.h.

class ByteWriter {
 public:
  template <typename Number>
  void number(Number value) {
    static_assert(std::is_arithmetic<Number>::value, "numbers only");
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  void count(std::size_t value) { number(static_cast<std::uint64_t>(value)); }
  void text(const std::string& value) {
    count(value.size());
    bytes_ += value;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Throws Error with the given sentence where the bytes end too early.
class ByteReader {
 public:
  ByteReader(const char* begin, std::size_t size, std::string sentence)
      : next_(begin), left_(size), sentence_(std::move(sentence)) {}

  template <typename Number>
  Number number() {
    static_assert(std::is_arithmetic<Number>::value, "numbers only");
    Number value;
    std::memcpy(&value, take(sizeof(value)), sizeof(value));
    return value;
  }
  std::size_t count() { return number<std::uint64_t>(); }
  /// A count of things that take so many bytes each, at least: no more than there can be.
  std::size_t count_of(std::size_t bytes_each) {
    const std::size_t result = count();
    require(result <= left_ / bytes_each);
    return result;
  }
  std::string text() {
    const std::size_t size = count_of(1);
    return std::string(take(size), size);
  }
  void require(bool condition) const {
    if (!condition) {
      throw Error(sentence_);
    }
  }

 private:
  const char* take(std::size_t size) {
    require(size <= left_);
    const char* result = next_;
    next_ += size;
    left_ -= size;
    return result;
  }

  const char* next_;
  std::size_t left_;
  std::string sentence_;
};

}  // namespace meshgrow

#endif
