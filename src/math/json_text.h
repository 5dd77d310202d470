#pragma once
/// Writes values as JSON.

#include <cmath>
#include <string>

#include <fmt/format.h>

namespace flexarm {

/// With 17 significant digits, so that the number can be read back exactly. JSON has no number that is not finite:
/// null.
inline std::string json_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.17g}", value) : "null";
}

inline std::string json_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += '\\', out += c;
    else if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      out += c;
  }
  return out + '"';
}

template <class Vector>
std::string json_array(const Vector& values) {
  std::string out;
  for (int i = 0; i < values.size(); ++i) out += (i > 0 ? ", " : "") + json_number(values[i]);
  return "[" + out + "]";
}

inline void append_member(std::string& object, const std::string& name, const std::string& value) {
  object += (object.empty() ? "" : ", ") + json_string(name) + ": " + value;
}

}  // namespace flexarm
