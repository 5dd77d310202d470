#pragma once
/// An XML element read with typed attributes; what is wrong is recorded with its line.

#include <initializer_list>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <tinyxml2.h>

#include "flexarm/scene/scene_description.h"
#include "scene/findings.h"

namespace flexarm::scene {

/// A condition on numbers, and how messages put it ("radius must be > 0").
struct NumberRange {
  const char* text;
  bool (*holds)(double);
};
constexpr NumberRange kAnyNumber{"a finite number", [](double) { return true; }};
/// Of what is squared and multiplied: the product of three such numbers and two squares is finite.
constexpr NumberRange kModerate{"at most 1e60 in absolute value", [](double x) { return -1e60 <= x && x <= 1e60; }};
constexpr NumberRange kPositive{"> 0", [](double x) { return x > 0; }};
constexpr NumberRange kNotZero{"different from 0", [](double x) { return x != 0; }};
/// Of stops: more than what a damper, however large, takes.
constexpr NumberRange kRestitution{"from 0.05 to 1", [](double x) { return x >= 0.05 && x <= 1; }};
constexpr NumberRange kNonNegative{">= 0", [](double x) { return x >= 0; }};

/// A view: element and findings must outlive it.
///
/// Readers of attributes return nothing (or the fallback) where an attribute is wrong, after recording why; an
/// attribute read without fallback must be there.
class XmlElement {
 public:
  /// `owner`: what messages call the thing that the element's children belong to ("joint 'elbow'").
  XmlElement(const tinyxml2::XMLElement& xml, std::string description, std::string owner, Findings& findings);

  std::string tag() const { return xml_->Name(); }
  const std::string& description() const { return description_; }
  int line() const { return xml_->GetLineNum(); }
  SourceLocation location() const { return {findings_->file(), line()}; }
  const tinyxml2::XMLElement& xml() const { return *xml_; }
  Findings& findings() const { return *findings_; }

  /// The same element, whose children belong to `owner`.
  XmlElement with_owner(std::string owner) const;
  /// The same element called "<joint> 'elbow'", whose children belong to "joint 'elbow'".
  XmlElement with_name(const std::string& name) const;

  // ---- findings about this element
  void error(std::string expected, std::string got = "") const;
  void warning(std::string expected, std::string got = "") const;
  /// About an attribute: its line and its value are added.
  void attribute_error(const char* attribute, std::string expected) const;

  // ---- structure
  std::vector<XmlElement> children() const;
  /// First child of this name.
  std::optional<XmlElement> child(const char* tag) const;
  /// Records children of these names that come twice; it is a warning where they say the same.
  void expect_at_most_one(std::initializer_list<const char*> tags) const;
  /// Inside an extension element: records every attribute, child and text that is not known here.
  void expect_only(std::initializer_list<const char*> attributes, std::initializer_list<const char*> tags = {}) const;

  // ---- attributes
  bool has(const char* attribute) const { return xml_->Attribute(attribute) != nullptr; }
  std::optional<std::string> text(const char* attribute) const;
  /// Name of a link, joint or probe: not empty, not absurdly long, no control characters.
  std::optional<std::string> name(const char* attribute) const;
  std::optional<double> number(const char* attribute, const NumberRange& range) const;
  double number(const char* attribute, const NumberRange& range, double fallback) const;
  /// `count` numbers separated by white space.
  std::optional<std::vector<double>> numbers(const char* attribute, std::size_t count, const NumberRange& range) const;
  /// Any count of them up to `most`.
  std::optional<std::vector<double>> all_numbers(const char* attribute, std::size_t most) const;
  /// `alternative` ends the message (" or 'auto'").
  std::optional<int> integer(const char* attribute, int least, int most, const char* alternative = "") const;
  /// Of moderate numbers.
  std::optional<Vector3> vector(const char* attribute) const;
  Vector3 vector(const char* attribute, const Vector3& fallback) const;
  /// A vector of unit length from one of any length but zero.
  std::optional<Vector3> direction(const char* attribute) const;
  /// A function of time, finite at t = 0, as a formula or as a column of a table (see csv_table.h).
  std::optional<TimeFunction> function(const char* attribute) const;

 private:
  const tinyxml2::XMLElement* xml_;
  std::string description_, owner_;
  Findings* findings_;
};

// ---------------------------------------------------------------- attributes whose values are names of a fixed set

template <class Value>
struct Choice {
  const char* name;
  Value value;
};

/// The row of a table with that `name` which the attribute gives; null where it is missing or unknown, which is
/// recorded.
template <class Table>
auto read_row(const XmlElement& element, const char* attribute, const Table& table) -> decltype(&*std::begin(table)) {
  const std::optional<std::string> name = element.text(attribute);
  if (!name) return nullptr;
  std::string known;
  for (const auto& row : table) {
    if (*name == row.name) return &row;
    known += (known.empty() ? "" : ", ") + std::string(row.name);
  }
  element.attribute_error(attribute, std::string(attribute) + " must be one of " + known);
  return nullptr;
}

/// What the attribute names among `choices`; nothing where it is missing or unknown, which is recorded.
template <class Value, std::size_t Count>
std::optional<Value> read_choice(const XmlElement& element, const char* attribute,
                                 const Choice<Value> (&choices)[Count]) {
  const Choice<Value>* choice = read_row(element, attribute, choices);
  return choice ? std::optional<Value>(choice->value) : std::nullopt;
}

/// The same for an attribute that may be left out.
template <class Value, std::size_t Count>
Value read_choice(const XmlElement& element, const char* attribute, const Choice<Value> (&choices)[Count],
                  Value fallback) {
  return element.has(attribute) ? read_choice(element, attribute, choices).value_or(fallback) : fallback;
}

}  // namespace flexarm::scene
