#pragma once
/// Collects the errors and warnings about one input file.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <tinyxml2.h>

#include "flexarm/scene/diagnostic.h"

namespace flexarm::scene {

/// Returns the value in quotes, shortened for a message (kLongestShownValue).
std::string quoted(std::string_view value);

class Findings {
 public:
  explicit Findings(std::string file) : file_(std::move(file)) {}

  /// Records an error. `expected`: what the input should be; `got`: what it is, in quotes (see quoted()), or empty if
  /// something is missing.
  void error(int line, std::string element, std::string expected, std::string got = "");
  void warning(int line, std::string element, std::string expected, std::string got = "");

  /// Stores the origin of an attribute's value that an expression has replaced (" of '${a + 1}' with a = 2").
  void note_origin(const tinyxml2::XMLAttribute& attribute, std::string origin);
  /// Returns the attribute's value in quotes, followed by its origin.
  std::string got(const tinyxml2::XMLAttribute& attribute) const;
  /// Returns the origin of the attribute's value; empty if the file gives the value itself.
  std::string origin(const tinyxml2::XMLAttribute& attribute) const;

  /// Returns the names that an unknown one could be, the nearest one first: " (hand, arm and 20 others)". Empty if
  /// there are none, or if so much was compared for other messages that more of it would take seconds.
  std::string candidates(std::string_view unknown, const std::vector<std::string>& names);

  const std::string& file() const { return file_; }
  std::size_t error_count() const { return error_count_; }
  /// Returns all findings, sorted by line, and leaves none here.
  Diagnostics take();

 private:
  void add(Diagnostic finding);

  std::string file_;
  Diagnostics findings_;
  std::size_t error_count_ = 0, omitted_ = 0, compared_ = 0;
  std::map<const tinyxml2::XMLAttribute*, std::string> origins_;
};

}  // namespace flexarm::scene
