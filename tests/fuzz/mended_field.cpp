#include "mended_field.h"

#include <algorithm>
#include <cstring>

#include "checked_blocks.h"
#include "field_layout.h"

namespace meshgrow::fuzz {

namespace {

using field_layout::Header;

/// As field_file.h describes the place of an array in the directory.
struct ArrayPlace {
  std::uint64_t begin;
  std::uint64_t count;
  std::uint32_t element_bytes;
  std::uint32_t shift;
};
static_assert(sizeof(ArrayPlace) == 24, "as documented");

bool is_array(const ArrayPlace& place, std::size_t size) {
  static constexpr std::uint32_t sizes[] = {4, 8, 32, 96, 192, 448, 512};
  return std::find(std::begin(sizes), std::end(sizes), place.element_bytes) != std::end(sizes) &&
         place.shift == block_shift(place.element_bytes) &&
         place.begin % field_layout::alignment == 0 && place.begin <= size && place.count > 0 &&
         place.count <= (size - place.begin) / place.element_bytes;
}

/// Wherever something in the directory looks like the place of an array: what stands between them
/// need not be understood.
void mend_arrays(std::uint8_t* file, std::size_t size, std::size_t directory) {
  for (std::size_t at = directory; at + sizeof(ArrayPlace) <= size; ++at) {
    ArrayPlace place;
    std::memcpy(&place, file + at, sizeof(place));
    if (!is_array(place, size)) {
      continue;
    }
    const auto sums = block_checksums(file + place.begin, place.count, place.element_bytes);
    const std::size_t bytes = sums.size() * sizeof(std::uint64_t);
    if (bytes <= size - at - sizeof(place)) {
      std::memcpy(file + at + sizeof(place), sums.data(), bytes);
      at += sizeof(place) + bytes - 1;
    }
  }
}

}  // namespace

std::size_t directory_of(const std::uint8_t* file, std::size_t size) {
  Header header = {};
  std::memcpy(&header, file, std::min(size, sizeof(header)));
  const bool is_sound = header.directory_begin >= sizeof(header) && header.directory_begin <= size;
  return is_sound ? header.directory_begin : size;
}

void mend_field(std::uint8_t* file, std::size_t size) {
  if (size < sizeof(Header)) {
    return;
  }
  const std::size_t directory = directory_of(file, size);
  mend_arrays(file, size, directory);
  Header header;
  std::memcpy(&header, file, sizeof(header));
  header.magic = field_layout::magic;
  header.version = field_layout::format_version;
  header.file_bytes = size;
  header.directory_begin = directory;
  header.directory_bytes = size - directory;
  header.directory_checksum = checksum(file + directory, size - directory);
  header.checksum = checksum(&header, offsetof(Header, checksum));
  std::memcpy(file, &header, sizeof(header));
}

}  // namespace meshgrow::fuzz
