#include "flexarm/scene/diagnostic.h"

#include <algorithm>

namespace flexarm::scene {

std::string Diagnostic::text() const {
  std::string text = file;
  if (line > 0) text += ":" + std::to_string(line);
  text += ": ";
  if (severity == Severity::Warning) text += "warning: ";
  if (!element.empty()) text += element + ": ";
  text += expected;
  if (!got.empty()) text += ", got " + got;
  return text;
}

bool has_errors(const Diagnostics& diagnostics) {
  return std::any_of(diagnostics.begin(), diagnostics.end(),
                     [](const Diagnostic& finding) { return finding.severity == Diagnostic::Severity::Error; });
}

std::string to_text(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& finding : diagnostics) text += finding.text() + "\n";
  return text;
}

}  // namespace flexarm::scene
