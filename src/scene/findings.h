#pragma once
/// Collects what is wrong with one input.

#include <map>
#include <string>
#include <string_view>

#include <tinyxml2.h>

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

  /// Where an attribute's value has come from, if it is not what the file says (" of '${a + 1}' with a = 2").
  void note_origin(const tinyxml2::XMLAttribute& attribute, std::string origin);
  /// The attribute's value in quotes, with its origin.
  std::string got(const tinyxml2::XMLAttribute& attribute) const;
  /// Empty: the file itself.
  std::string origin(const tinyxml2::XMLAttribute& attribute) const;

  const std::string& file() const { return file_; }
  std::size_t error_count() const { return error_count_; }
  /// All findings in the order of their lines.
  Diagnostics take();

 private:
  void add(Diagnostic finding);

  std::string file_;
  Diagnostics findings_;
  std::size_t error_count_ = 0, omitted_ = 0;
  std::map<const tinyxml2::XMLAttribute*, std::string> origins_;
};

}  // namespace flexarm::scene
