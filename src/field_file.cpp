#include "field_file.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "error.h"
#include "field_layout.h"
#include "field_reader.h"
#include "field_writer.h"

namespace meshgrow {

void save_field(const SizeField& field, const std::string& path) {
  const SizeField::Parts parts = field.parts();
  const std::string unfinished = path + ".unfinished";
  const auto fail = [&](int problem) {
    std::remove(unfinished.c_str());
    throw Error("Cannot write " + path + " (" + std::strerror(problem) +
                "): choose another file, or make room for it.");
  };
  errno = 0;
  try {
    if (!write_field(parts, unfinished)) {
      fail(errno);
    }
  } catch (...) {
    std::remove(unfinished.c_str());
    throw;
  }
  if (std::rename(unfinished.c_str(), path.c_str()) != 0) {
    fail(errno);
  }
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
