#include "quoted_text.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace meshgrow::cli {

std::string shell_quoted(const std::string& text) {
  const auto is_harmless = [](unsigned char c) {
    return std::isalnum(c) != 0 || c >= 0x80 ||
           (c != '\0' && std::strchr("/._-+,:@%=", c) != nullptr);
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), is_harmless)) {
    return text;
  }
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' ? "'\\''" : std::string(1, c);
  }
  return quoted + "'";
}

std::string double_quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  }
  return quoted + "\"";
}

}  // namespace meshgrow::cli
