#pragma once
/// Errors and warnings about an input, as data.

#include <string>
#include <vector>

namespace flexarm::scene {

/// An error or a warning about an input file.
struct Diagnostic {
  enum class Severity { Warning, Error };
  Severity severity = Severity::Error;
  std::string file;
  int line = 0;          ///< 1-based; 0 where no line is known
  std::string element;   ///< "<circle> of beam 'forearm'"
  std::string got;       ///< "'-0.01'", with its quotes; empty where something is missing
  std::string expected;  ///< "radius must be > 0"

  /// `scene.urdf:41: <circle> of beam 'forearm': radius must be > 0, got '-0.01'`
  std::string text() const;
};

using Diagnostics = std::vector<Diagnostic>;

/// Whether any of them is an error.
bool has_errors(const Diagnostics& diagnostics);
/// One per line.
std::string to_text(const Diagnostics& diagnostics);

}  // namespace flexarm::scene
