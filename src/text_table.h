#ifndef MESHGROW_TEXT_TABLE_H
#define MESHGROW_TEXT_TABLE_H

#include <string>
#include <vector>

namespace meshgrow {

/// Rows of equally many cells as lines of text, columns side by side: the first and those of
/// `left` begin at the left, the others end at the right, as numbers do.
std::string text_table(const std::vector<std::vector<std::string>>& rows,
                       const std::vector<std::size_t>& left = {});

}  // namespace meshgrow

#endif
