#ifndef MESHGROW_NUMBER_TEXT_H
#define MESHGROW_NUMBER_TEXT_H

#include <cstddef>
#include <string>

/// Numbers as text, the same whatever the program's locale.
namespace meshgrow {

/// "1,234,567".
std::string grouped_digits(std::size_t value);

/// With so many decimals; "-" for a value that is not a number.
std::string rounded(double value, int decimals);

/// The shortest text of so many digits at most: "0.1", "1e+22".
std::string shortest(double value, int digits = 6);

/// The shortest text that reads as exactly this number again.
std::string exact_text(double value);

}  // namespace meshgrow

#endif
