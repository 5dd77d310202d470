#pragma once
/// A fingerprint of data, to tell whether two of them are the same.

#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace flexarm {

/// FNV-1a of 64 bits. A byte is taken in by an exclusive or and a product with an odd number, both one-to-one: data of
/// equal length that differ in one byte never have the same fingerprint.
class Fingerprint {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  }
  /// 16 hexadecimal digits.
  std::string text() const { return fmt::format("{:016x}", value_); }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace flexarm
