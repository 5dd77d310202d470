/// Tests texts of numbers: they are read back bit for bit, what is refused, and that the locale does not matter.
#include "math/number_text.h"

#include <clocale>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace flexarm {
namespace {

std::string written(double value, NumberFormat format) {
  char text[kLongestNumber];
  return std::string(text, write_number(text, value, format) - text);
}

bool are_same_bits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(NumberText, IsReadBackBitForBit) {
  std::mt19937_64 random(1);
  for (int k = 0; k < 20000; ++k) {
    const std::uint64_t bits = random();
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    if (k % 3 == 1) value = std::ldexp(static_cast<double>(bits >> 11), -60);
    if (k == 2) value = std::numeric_limits<double>::denorm_min();
    if (k == 5) value = std::numeric_limits<double>::max();
    if (k == 8) value = -0.0;
    if (!std::isfinite(value)) continue;
    const std::optional<double> shortest = parse_number(written(value, NumberFormat::Shortest)),
                                hexadecimal = parse_hexadecimal(written(value, NumberFormat::Hexadecimal));
    ASSERT_TRUE(shortest && are_same_bits(*shortest, value)) << value;
    ASSERT_TRUE(hexadecimal && are_same_bits(*hexadecimal, value)) << value;
  }
}

TEST(NumberText, IsWrittenAsExpected) {
  EXPECT_EQ(written(0.1, NumberFormat::Shortest), "0.1");
  EXPECT_EQ(written(100, NumberFormat::Shortest), "100");
  EXPECT_EQ(written(1e300, NumberFormat::Shortest), "1e+300");
  EXPECT_EQ(written(0.1 + 0.2, NumberFormat::Shortest), "0.30000000000000004");
  EXPECT_EQ(written(-12, NumberFormat::Hexadecimal), "-1.8p+3");
  EXPECT_EQ(written(std::numeric_limits<double>::infinity(), NumberFormat::Shortest), "inf");
  EXPECT_EQ(written(-std::numeric_limits<double>::infinity(), NumberFormat::Shortest), "-inf");
}

TEST(NumberText, TakesNumbersAndNothingElse) {
  EXPECT_EQ(parse_number("1.5"), 1.5);
  EXPECT_EQ(parse_number("+2"), 2.0);
  EXPECT_EQ(parse_number("-.5E-1"), -0.05);
  EXPECT_EQ(parse_hexadecimal("-1.8p+3"), -12.0);
  for (const char* text :
       {"",    " 1",        "1 ",    "++1",    "+-1",    "-+1", "--1",    "-",   "+",    ".",   "0x10", "nan",
        "inf", "-infinity", "1e999", "-1e999", "1e-999", "1e",  "1.5abc", "1,5", "1.5.", "1e+", "e5"})
    EXPECT_FALSE(parse_number(text)) << text;
  for (const char* text : {"", "0x1p+3", "+1p+3", "1.8p", "nan", "inf", "1p+9999", " 1p+3", "1,8p+3"})
    EXPECT_FALSE(parse_hexadecimal(text)) << text;
}

// A locale with a decimal comma, for example German, if the machine has one.
TEST(NumberText, DoesNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  const char* with_comma = nullptr;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "nl_NL.UTF-8"})
    if (!with_comma) with_comma = std::setlocale(LC_ALL, name);
  if (!with_comma) GTEST_SKIP() << "this machine has no locale with a decimal comma";
  const std::string shortest = written(0.5, NumberFormat::Shortest);
  const std::optional<double> value = parse_number("0.5");
  std::setlocale(LC_ALL, before.c_str());
  EXPECT_EQ(shortest, "0.5");
  EXPECT_EQ(value, 0.5);
}

}  // namespace
}  // namespace flexarm
