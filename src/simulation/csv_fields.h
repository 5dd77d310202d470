#pragma once
/// Appends fields to a line of comma-separated values.

#include <string>

#include "math/number_text.h"

namespace flexarm::csv {

/// Appends a text, in quotes if it contains separators (RFC 4180).
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

/// Appends a number by the shortest text that is read back bit for bit, in any locale.
inline void append(std::string& line, double value) {
  if (!line.empty()) line += ',';
  char digits[kLongestNumber];
  line.append(digits, write_number(digits, value, NumberFormat::Shortest) - digits);
}

}  // namespace flexarm::csv
