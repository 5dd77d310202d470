#pragma once
/// Fields of a line of comma-separated values.

#include <array>
#include <charconv>
#include <string>

namespace flexarm::csv {

/// A field that contains separators stands in quotes (RFC 4180).
inline void append(std::string& line, const std::string& name) {
  if (!line.empty()) line += ',';
  if (name.find_first_of(",\"") == std::string::npos) {
    line += name;
    return;
  }
  line += '"';
  for (const char c : name) line += c == '"' ? std::string("\"\"") : std::string(1, c);
  line += '"';
}

/// With 17 significant digits, so that it is read back bit for bit, whatever the locale.
inline void append(std::string& line, double value) {
  if (!line.empty()) line += ',';
  std::array<char, 32> digits;  // a sign, 17 digits, a point, an exponent of five: 24
  const std::to_chars_result written =
      std::to_chars(digits.begin(), digits.end(), value, std::chars_format::general, 17);
  line.append(digits.begin(), written.ptr);
}

}  // namespace flexarm::csv
