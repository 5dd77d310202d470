#pragma once
/// Collects what is wrong with one input.

#include <string>
#include <string_view>

#include "flexarm/scene/diagnostic.h"

namespace flexarm::scene {

/// The value in quotes as messages show it: shortened.
std::string quoted(std::string_view value);

class Findings {
 public:
  explicit Findings(std::string file) : file_(std::move(file)) {}

  /// `got` in quotes (see quoted()); empty where something is missing.
  void error(int line, std::string element, std::string expected, std::string got = "");
  void warning(int line, std::string element, std::string expected, std::string got = "");

  const std::string& file() const { return file_; }
  std::size_t error_count() const { return error_count_; }
  /// All findings in the order of their lines.
  Diagnostics take();

 private:
  void add(Diagnostic finding);

  std::string file_;
  Diagnostics findings_;
  std::size_t error_count_ = 0, omitted_ = 0;
};

}  // namespace flexarm::scene
