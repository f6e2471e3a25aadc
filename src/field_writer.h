#ifndef MESHGROW_FIELD_WRITER_H
#define MESHGROW_FIELD_WRITER_H

#include <string>

#include "size_field.h"

namespace meshgrow {

/// Writes a file of field_file.h. False, with errno set, if it could not be written to its end.
bool write_field(const SizeField::Parts& field, const std::string& path);

}  // namespace meshgrow

#endif
