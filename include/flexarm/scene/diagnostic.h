#pragma once
/// Errors and warnings about an input file, as data.

#include <string>
#include <vector>

namespace flexarm::scene {

/// An error or a warning about an input file.
struct Diagnostic {
  enum class Severity { Warning, Error };
  Severity severity = Severity::Error;
  std::string file;
  int line = 0;          ///< 1-based; 0 if unknown
  std::string element;   ///< "<circle> of beam 'forearm'"
  std::string got;       ///< what was read, quoted: "'-0.01'"; empty if something is missing
  std::string expected;  ///< "radius must be > 0"

  /// `scene.urdf:41: <circle> of beam 'forearm': radius must be > 0, got '-0.01'`
  std::string text() const;
};

using Diagnostics = std::vector<Diagnostic>;

/// Whether at least one diagnostic is an error.
bool has_errors(const Diagnostics& diagnostics);
/// All diagnostics as text, one per line.
std::string to_text(const Diagnostics& diagnostics);

}  // namespace flexarm::scene
