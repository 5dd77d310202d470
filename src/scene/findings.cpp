#include "scene/findings.h"

#include <algorithm>

#include "flexarm/math/near_names.h"
#include "scene/limits.h"

namespace flexarm::scene {
namespace {

/// Replaces control characters by blanks, so that a finding stays on one line whatever the input contains.
std::string without_control_characters(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, ' ');
  return text;
}

}  // namespace

std::string quoted(std::string_view value) {
  std::size_t shown = std::min(value.size(), kLongestShownValue);
  // Do not cut in the middle of a UTF-8 sequence.
  while (shown < value.size() && shown > 0 && (static_cast<unsigned char>(value[shown]) & 0xC0) == 0x80) --shown;
  return "'" + std::string(value.substr(0, shown)) + (shown < value.size() ? "...'" : "'");
}

void Findings::error(int line, std::string element, std::string expected, std::string got) {
  ++error_count_;
  add({Diagnostic::Severity::Error, file_, line, without_control_characters(std::move(element)),
       without_control_characters(std::move(got)), without_control_characters(std::move(expected))});
}

void Findings::warning(int line, std::string element, std::string expected, std::string got) {
  add({Diagnostic::Severity::Warning, file_, line, without_control_characters(std::move(element)),
       without_control_characters(std::move(got)), without_control_characters(std::move(expected))});
}

void Findings::note_origin(const tinyxml2::XMLAttribute& attribute, std::string origin) {
  origins_[&attribute] = std::move(origin);
}

std::string Findings::got(const tinyxml2::XMLAttribute& attribute) const {
  return quoted(attribute.Value()) + origin(attribute);
}

std::string Findings::origin(const tinyxml2::XMLAttribute& attribute) const {
  const auto found = origins_.find(&attribute);
  return found == origins_.end() ? "" : found->second;
}

std::string Findings::candidates(std::string_view unknown, const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 30'000'000;  // pairs of letters: a third of a second
  if (names.empty() || unknown.size() > kLongestName || compared_ > kMost) return "";
  for (const std::string& name : names) compared_ += (unknown.size() + 1) * (name.size() + 1);
  return compared_ > kMost ? "" : " (" + nearest_listed(unknown, names) + ")";
}

void Findings::add(Diagnostic finding) {
  // The first error is always listed, even if warnings have used up the list.
  const bool first_error = finding.severity == Diagnostic::Severity::Error && error_count_ == 1;
  if (findings_.size() < kMostFindings || first_error) {
    findings_.push_back(std::move(finding));
  } else {
    ++omitted_;
  }
}

Diagnostics Findings::take() {
  std::stable_sort(findings_.begin(), findings_.end(),
                   [](const Diagnostic& a, const Diagnostic& b) { return a.line < b.line; });
  if (omitted_ > 0) {
    const Diagnostic::Severity severity =
        error_count_ > 0 ? Diagnostic::Severity::Error : Diagnostic::Severity::Warning;
    findings_.push_back({severity, file_, 0, "scene", "", std::to_string(omitted_) + " further findings"});
  }
  return std::move(findings_);
}

// ---------------------------------------------------------------- as text for users

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
