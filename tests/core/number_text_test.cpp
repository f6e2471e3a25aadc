#include "number_text.h"

#include <gtest/gtest.h>

#include <limits>
#include <locale>

namespace meshgrow {
namespace {

TEST(NumberText, DigitsInGroupsOfThree) {
  EXPECT_EQ(grouped_digits(0), "0");
  EXPECT_EQ(grouped_digits(999), "999");
  EXPECT_EQ(grouped_digits(1000), "1,000");
  EXPECT_EQ(grouped_digits(123456), "123,456");
  EXPECT_EQ(grouped_digits(1234567), "1,234,567");
  EXPECT_EQ(grouped_digits(1000000000), "1,000,000,000");
}

TEST(NumberText, RoundedToDecimals) {
  EXPECT_EQ(rounded(1.2345, 2), "1.23");
  EXPECT_EQ(rounded(1.236, 2), "1.24");
  EXPECT_EQ(rounded(-0.5, 3), "-0.500");
  EXPECT_EQ(rounded(7.0, 0), "7");
  EXPECT_EQ(rounded(std::numeric_limits<double>::quiet_NaN(), 2), "-");
}

TEST(NumberText, ShortestOfSixDigits) {
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(shortest(1e22), "1e+22");
  EXPECT_EQ(shortest(2.0), "2");
  EXPECT_EQ(shortest(1.0 / 3.0), "0.333333");
}

TEST(NumberText, ExactTextReadsAsTheSameNumber) {
  EXPECT_EQ(exact_text(0.1), "0.1");
  EXPECT_EQ(exact_text(2.0), "2");
  EXPECT_EQ(exact_text(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(std::stod(exact_text(1.0 / 3.0)), 1.0 / 3.0);
}

/// Points for thousands and a comma for decimals, as a program in another language may have set.
class CommaForDecimals : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(NumberText, IsTheSameInEveryLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaForDecimals));
  EXPECT_EQ(rounded(1234.5, 1), "1234.5");
  EXPECT_EQ(shortest(1234.5), "1234.5");
  EXPECT_EQ(grouped_digits(1234567), "1,234,567");
  EXPECT_EQ(exact_text(1234.5), "1234.5");
  std::locale::global(before);
}

}  // namespace
}  // namespace meshgrow
