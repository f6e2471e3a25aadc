#include "number_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <locale>
#include <system_error>

#include "text_stream.h"

namespace meshgrow {

std::string grouped_digits(std::size_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t from_end = 3; from_end < digits.size(); from_end += 4) {
    digits.insert(digits.size() - from_end, ",");
  }
  return digits;
}

std::string rounded(double value, int decimals) {
  if (std::isnan(value)) {
    return "-";
  }
  TextStream text;
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

std::string shortest(double value, int digits) {
  TextStream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(digits) << value;
  return text.str();
}

std::string exact_text(double value) {
  std::array<char, 32> text;
  const auto [end, problem] = std::to_chars(text.data(), text.data() + text.size(), value);
  return std::string(text.data(), problem == std::errc() ? end : text.data());
}

}  // namespace meshgrow
