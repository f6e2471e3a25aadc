#ifndef MESHGROW_NUMBER_TEXT_H
#define MESHGROW_NUMBER_TEXT_H

#include <cstddef>
#include <string>

namespace meshgrow {

/// "1,234,567".
std::string grouped_digits(std::size_t value);

/// With so many decimals; "-" for a value that is not a number.
std::string rounded(double value, int decimals);

/// The shortest text of six digits at most: "0.1", "1e+22".
std::string shortest(double value);

}  // namespace meshgrow

#endif
