#pragma once
/// Reads typed attributes of an XML element, and records errors with their line.

#include <initializer_list>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <tinyxml2.h>

#include "flexarm/scene/scene_description.h"
#include "scene/findings.h"

namespace flexarm::scene {

/// A condition on numbers, and its text in messages ("radius must be > 0").
struct NumberRange {
  const char* text;
  bool (*holds)(double);
};
constexpr NumberRange kAnyNumber{"a finite number", [](double) { return true; }};
/// For numbers that are squared and multiplied: the product of three such numbers, two of them squared, is finite.
constexpr NumberRange kModerate{"at most 1e60 in absolute value", [](double x) { return -1e60 <= x && x <= 1e60; }};
constexpr NumberRange kPositive{"> 0", [](double x) { return x > 0; }};
constexpr NumberRange kNotZero{"different from 0", [](double x) { return x != 0; }};
/// Coefficient of restitution of stops. The lower bound excludes 0, since no finite damper absorbs the whole impact.
constexpr NumberRange kRestitution{"from 0 to 1", [](double x) { return x >= 0 && x <= 1; }};
constexpr NumberRange kNonNegative{">= 0", [](double x) { return x >= 0; }};

/// A view of an XML element. The tinyxml2 element and the Findings must outlive it.
///
/// If an attribute is wrong, the functions that read it record an error and return nothing, or the fallback. If an
/// attribute is missing, that is an error only without a fallback.
class XmlElement {
 public:
  /// `description`: name of this element in messages. `owner`: in messages, the thing that the element's children
  /// belong to ("joint 'elbow'").
  XmlElement(const tinyxml2::XMLElement& xml, std::string description, std::string owner, Findings& findings);

  std::string tag() const { return xml_->Name(); }
  const std::string& description() const { return description_; }
  int line() const { return xml_->GetLineNum(); }
  SourceLocation location() const { return {findings_->file(), line()}; }
  const tinyxml2::XMLElement& xml() const { return *xml_; }
  Findings& findings() const { return *findings_; }

  /// Returns the same element with another `owner` of its children.
  XmlElement with_owner(std::string owner) const;
  /// Returns the same element with the description "<joint> 'elbow'" and the owner "joint 'elbow'", for example.
  XmlElement with_name(const std::string& name) const;

  // ---- findings about this element
  void error(std::string expected, std::string got = "") const;
  void warning(std::string expected, std::string got = "") const;
  /// Records an error about an attribute. Adds the attribute's line and value.
  void attribute_error(const char* attribute, std::string expected) const;

  // ---- structure
  std::vector<XmlElement> children() const;
  /// Returns the first child with this tag.
  std::optional<XmlElement> child(const char* tag) const;
  /// Records an error for each repeated child with one of these tags; only a warning if it equals the first one.
  void expect_at_most_one(std::initializer_list<const char*> tags) const;
  /// The same for elements of URDF, of which other programs read the first one: only a warning for each repeated child.
  void expect_first_counts(std::initializer_list<const char*> tags) const;
  /// Records an error for every other attribute and child, and for text. For elements of flexarm, which no other
  /// program extends.
  void expect_only(std::initializer_list<const char*> attributes, std::initializer_list<const char*> tags = {}) const;

  // ---- attributes
  bool has(const char* attribute) const { return xml_->Attribute(attribute) != nullptr; }
  std::optional<std::string> text(const char* attribute) const;
  /// Reads a name, as of a link: not empty, not longer than kLongestName, without control characters.
  std::optional<std::string> name(const char* attribute) const;
  std::optional<double> number(const char* attribute, const NumberRange& range) const;
  double number(const char* attribute, const NumberRange& range, double fallback) const;
  /// Reads exactly `count` numbers, separated by white space.
  std::optional<std::vector<double>> numbers(const char* attribute, std::size_t count, const NumberRange& range) const;
  /// Reads up to `most` numbers, separated by white space.
  std::optional<std::vector<double>> all_numbers(const char* attribute, std::size_t most) const;
  /// Reads a whole number. `alternative`: end of the error message (" or 'auto'").
  std::optional<int> integer(const char* attribute, int least, int most, const char* alternative = "") const;
  /// Reads three numbers in the range kModerate.
  std::optional<Vector3> vector(const char* attribute) const;
  Vector3 vector(const char* attribute, const Vector3& fallback) const;
  /// Reads a vector, which must not be zero, and normalises it.
  std::optional<Vector3> direction(const char* attribute) const;
  /// Reads a function of time: a formula, or a column of a table (see csv_table.h). It must be finite at t = 0.
  std::optional<TimeFunction> function(const char* attribute) const;

 private:
  void warn_or_refuse_repeated(std::initializer_list<const char*> tags, bool first_counts) const;

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

/// Returns the row of a table whose `name` is the attribute's value. If the attribute is missing or its value unknown,
/// records an error and returns null.
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

/// Returns the value of the choice that the attribute names. If the attribute is missing or its value unknown, records
/// an error and returns nothing.
template <class Value, std::size_t Count>
std::optional<Value> read_choice(const XmlElement& element, const char* attribute,
                                 const Choice<Value> (&choices)[Count]) {
  const Choice<Value>* choice = read_row(element, attribute, choices);
  return choice ? std::optional<Value>(choice->value) : std::nullopt;
}

/// The same for an optional attribute, with a `fallback` if it is missing.
template <class Value, std::size_t Count>
Value read_choice(const XmlElement& element, const char* attribute, const Choice<Value> (&choices)[Count],
                  Value fallback) {
  return element.has(attribute) ? read_choice(element, attribute, choices).value_or(fallback) : fallback;
}

}  // namespace flexarm::scene
