#ifndef MESHGROW_FIELD_LAYOUT_H
#define MESHGROW_FIELD_LAYOUT_H

#include <array>
#include <cstddef>
#include <cstdint>

#include "grid_nodes.h"
#include "tree_layout.h"

/// What the writer and the reader of field_file.h share.
namespace meshgrow::field_layout {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the file is mapped as it is");

constexpr std::array<char, 8> magic = {'\x89', 'M', 'G', 'F', '\r', '\n', '\x1a', '\n'};
constexpr std::uint32_t format_version = 1;
constexpr std::size_t alignment = 64;  ///< of arrays

struct Header {
  std::array<char, 8> magic;
  std::uint32_t version;
  std::uint32_t zero_0;
  std::uint64_t file_bytes;
  std::uint64_t directory_begin;
  std::uint64_t directory_bytes;
  std::uint64_t directory_checksum;
  std::uint64_t zero_1;
  std::uint64_t checksum;  ///< of all before
};
static_assert(sizeof(Header) == 64 && offsetof(Header, checksum) == 56, "as documented");

// What is mapped as it stands in memory.
static_assert(sizeof(SizedFacet) == 96 && offsetof(SizedFacet, start_size) == 80 &&
                  sizeof(WideBoxes) == 192 && sizeof(GridTable::Entry) == 8,
              "as documented");

}  // namespace meshgrow::field_layout

#endif
