#pragma once
/// Numbers to and from text, whatever the locale.

#include <cstddef>
#include <optional>
#include <string_view>

namespace flexarm {

/// The finite number that makes up the whole of `text`, as "1.5", "+2" or "1e-3"; nothing for "1.5abc", "nan" or
/// "1e999".
std::optional<double> parse_number(std::string_view text);
/// The same of hexadecimal digits without "0x", as "-1.8p+3".
std::optional<double> parse_hexadecimal(std::string_view text);

/// How a number is written. Each is read back bit for bit.
enum class NumberFormat {
  Shortest,     ///< as 0.1 or 1e+300
  AllDigits,    ///< 17 of them, as 0.10000000000000001
  Hexadecimal,  ///< without "0x"
};
constexpr std::size_t kLongestNumber = 32;
/// Writes at `begin`, where kLongestNumber characters have room; returns the end of what is written.
char* write_number(char* begin, double value, NumberFormat format);

/// Takes the next word, separated by white space, off the front of `text`; empty at the end.
inline std::string_view next_word(std::string_view& text) {
  constexpr std::string_view kSpace = " \t\r\n\f\v";
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) {
    text = {};
    return {};
  }
  text.remove_prefix(begin);
  const std::string_view word = text.substr(0, text.find_first_of(kSpace));
  text.remove_prefix(word.size());
  return word;
}

}  // namespace flexarm
