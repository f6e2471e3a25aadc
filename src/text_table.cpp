#include "text_table.h"

#include <algorithm>

#include "text_stream.h"

namespace meshgrow {

namespace {

/// Columns that count bytes of UTF-8 wrongly would not line up.
std::size_t displayed_width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

}  // namespace

std::string text_table(const std::vector<std::vector<std::string>>& rows,
                       const std::vector<std::size_t>& left) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], displayed_width(row[i]));
    }
  }
  TextStream text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - displayed_width(row[i]), ' ');
      const bool begins_left = i == 0 || std::find(left.begin(), left.end(), i) != left.end();
      line += (i == 0 ? "" : "  ") + (begins_left ? row[i] + padding : padding + row[i]);
    }
    text << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
  }
  return text.str();
}

}  // namespace meshgrow
