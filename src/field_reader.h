#ifndef MESHGROW_FIELD_READER_H
#define MESHGROW_FIELD_READER_H

#include <memory>
#include <string>

#include "mapped_file.h"
#include "size_field.h"

namespace meshgrow {

/// What a file of field_file.h holds; it stays mapped as long as something of it is used. `path` is
/// for messages. Throws Error if it is truncated, damaged, or no such file.
SizeField::Parts read_field(const std::string& path, std::shared_ptr<const MappedFile> file);

}  // namespace meshgrow

#endif
