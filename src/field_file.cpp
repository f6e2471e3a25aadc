#include "field_file.h"

#include <array>
#include <fstream>

#include "field_layout.h"
#include "field_reader.h"
#include "field_writer.h"
#include "whole_file.h"

namespace meshgrow {

void save_field(const SizeField& field, const std::string& path) {
  const SizeField::Parts parts = field.parts();
  write_whole_file(
      path, [&parts](const std::string& unfinished) { return write_field(parts, unfinished); });
}

SizeField load_field(const std::string& path) {
  return SizeField(read_field(path, std::make_shared<const MappedFile>(path)));
}

bool is_field_file(const std::string& path) {
  std::array<char, field_layout::magic.size()> begin = {};
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), begin.size());
  return file && begin == field_layout::magic;
}

}  // namespace meshgrow
