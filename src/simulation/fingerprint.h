#pragma once
/// A hash of data, to tell whether two pieces of data are the same.

#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace flexarm {

/// FNV-1a with 64 bits. Each byte is combined with the hash by an exclusive or, and the result is multiplied by an odd
/// number. Since both operations are one-to-one, data of equal length that differ in one byte never have the same hash.
class Fingerprint {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  }
  /// The hash as 16 hexadecimal digits.
  std::string text() const { return fmt::format("{:016x}", value_); }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace flexarm
