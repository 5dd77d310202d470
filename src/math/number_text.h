#pragma once
/// Converts numbers to and from text, independently of the locale.

#include <cstddef>
#include <optional>
#include <string_view>

namespace flexarm {

/// Parses `text`, which must be a finite number and nothing else, as "1.5", "+2" or "1e-3". Returns nothing for other
/// texts, as "1.5abc", "nan" or "1e999".
std::optional<double> parse_number(std::string_view text);
/// The same for hexadecimal numbers without "0x", as "-1.8p+3".
std::optional<double> parse_hexadecimal(std::string_view text);

/// Formats for writing numbers. All of them are read back exactly.
enum class NumberFormat {
  Shortest,     ///< as 0.1 or 1e+300
  Hexadecimal,  ///< without "0x"
};
constexpr std::size_t kLongestNumber = 32;
/// Writes a number at `begin`, which must have room for kLongestNumber characters. Returns the end of the written text.
char* write_number(char* begin, double value, NumberFormat format);

/// Removes the next word, separated by white space, from the front of `text`, and returns it; empty if there is none.
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
