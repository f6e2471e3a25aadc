#ifndef MESHGROW_FIELD_SUMMARY_H
#define MESHGROW_FIELD_SUMMARY_H

#include <string>

#include "size_field.h"

namespace meshgrow {

/// A table of the field's size functions and one of its groups, for people: sources, attachments
/// and parameters; facets, trees, grids, memory, seconds of building, and sizes answered so far.
/// Empty without functions.
std::string summary_table(const SizeField& field);

}  // namespace meshgrow

#endif
