#include "math/number_text.h"

#include <charconv>
#include <cmath>

// GCC has std::from_chars and std::to_chars for double from version 11 on. Before, C functions are used, which depend
// on the locale.
#ifndef __cpp_lib_to_chars
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <string>
#endif

namespace flexarm {
namespace {

#ifdef __cpp_lib_to_chars

std::optional<double> parse(std::string_view text, bool is_hexadecimal) {
  double value = 0;
  const char* end = text.data() + text.size();
  const std::from_chars_result result =
      std::from_chars(text.data(), end, value, is_hexadecimal ? std::chars_format::hex : std::chars_format::general);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

#else

locale_t plain_locale() {
  static const locale_t locale = newlocale(LC_ALL_MASK, "C", nullptr);
  return locale;
}

std::optional<double> parse(std::string_view text, bool is_hexadecimal) {
  const std::size_t digits = !text.empty() && text[0] == '-';
  // strtod() accepts more than parse_number() should: white space, a sign '+', "0x", and names such as "inf".
  const char* allowed = is_hexadecimal ? "0123456789abcdefABCDEF.pP+-" : "0123456789.eE+-";
  if (digits == text.size() || text[digits] == '+' || text[digits] == '-' ||
      text.find_first_not_of(allowed) != std::string_view::npos)
    return std::nullopt;
  std::string whole(text);
  if (is_hexadecimal) whole.insert(digits, "0x");
  char* end = nullptr;
  errno = 0;
  const double value = strtod_l(whole.c_str(), &end, plain_locale());
  const bool is_out_of_range = errno == ERANGE && (value == 0 || !std::isfinite(value));
  if (end != whole.c_str() + whole.size() || is_out_of_range) return std::nullopt;
  return value;
}

/// Returns the shortest text that is read back as the same number. If texts with and without exponent have the same
/// length, returns the one without.
std::string shortest(double value) {
  std::string best(kLongestNumber, ' ');
  char text[kLongestNumber];
  snprintf(text, sizeof text, "%.15g", value);
  // Most results need 16 or 17 digits. If 15 are not enough, fewer are not either.
  for (int digits = strtod(text, nullptr) == value ? 1 : 16; digits <= 17; ++digits) {
    const std::size_t length = snprintf(text, sizeof text, "%.*g", digits, value);
    if (length <= best.size() && strtod(text, nullptr) == value) best.assign(text, length);
  }
  return best;
}

#endif

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return parse(text, false);
}

std::optional<double> parse_hexadecimal(std::string_view text) {
  return parse(text, true);
}

#ifdef __cpp_lib_to_chars

char* write_number(char* begin, double value, NumberFormat format) {
  char* end = begin + kLongestNumber;
  switch (format) {
    case NumberFormat::Hexadecimal:
      return std::to_chars(begin, end, value, std::chars_format::hex).ptr;
    default:
      return std::to_chars(begin, end, value).ptr;
  }
}

#else

char* write_number(char* begin, double value, NumberFormat format) {
  const locale_t users = uselocale(plain_locale());
  std::string text;
  if (format == NumberFormat::Shortest) {
    text = std::isfinite(value) ? shortest(value) : std::isnan(value) ? "nan" : value < 0 ? "-inf" : "inf";
  } else {
    char all[kLongestNumber];
    text.assign(all, snprintf(all, sizeof all, "%a", value));
    if (const std::size_t prefix = text.find("0x"); prefix != std::string::npos) text.erase(prefix, 2);
  }
  uselocale(users);
  return std::copy(text.begin(), text.end(), begin);
}

#endif

}  // namespace flexarm
