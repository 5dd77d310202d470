#pragma once
/// Fields of a line of comma-separated values.

#include <iterator>
#include <string>

#include <fmt/format.h>

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
  fmt::format_to(std::back_inserter(line), "{:.17g}", value);
}

}  // namespace flexarm::csv
