#include "scene/xml_element.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <stdexcept>

#include "flexarm/math/near_names.h"
#include "math/number_text.h"
#include "scene/csv_table.h"
#include "scene/limits.h"

namespace flexarm::scene {
namespace {

bool contains(std::initializer_list<const char*> names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Returns "a, b, c"; "nothing" if there are no names.
std::string listed(std::initializer_list<const char*> names) {
  std::string text;
  for (const char* name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text.empty() ? "nothing" : text;
}

/// Returns "; did you mean 'NAME'?" if one of the names is near to an unknown one; else an empty text.
std::string meant(std::string unknown, std::initializer_list<const char*> names) {
  if (unknown.size() > kLongestName) return "";
  std::transform(unknown.begin(), unknown.end(), unknown.begin(), [](unsigned char c) { return std::tolower(c); });
  return suggestion(unknown, {names.begin(), names.end()});
}

/// Parses numbers that are separated by white space. Returns nothing if one is not a finite number, or there are more
/// than `most`.
std::optional<std::vector<double>> parse_numbers(std::string_view text, std::size_t most) {
  std::vector<double> numbers;
  for (std::string_view word = next_word(text); !word.empty(); word = next_word(text)) {
    const std::optional<double> number = parse_number(word);
    if (!number || numbers.size() == most) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace

XmlElement::XmlElement(const tinyxml2::XMLElement& xml, std::string description, std::string owner, Findings& findings)
    : xml_(&xml), description_(std::move(description)), owner_(std::move(owner)), findings_(&findings) {}

XmlElement XmlElement::with_owner(std::string owner) const {
  return XmlElement(*xml_, description_, std::move(owner), *findings_);
}

XmlElement XmlElement::with_name(const std::string& name) const {
  return XmlElement(*xml_, "<" + tag() + "> " + quoted(name), tag() + " " + quoted(name), *findings_);
}

void XmlElement::error(std::string expected, std::string got) const {
  findings_->error(line(), description_, std::move(expected), std::move(got));
}

void XmlElement::warning(std::string expected, std::string got) const {
  findings_->warning(line(), description_, std::move(expected), std::move(got));
}

void XmlElement::attribute_error(const char* attribute, std::string expected) const {
  const tinyxml2::XMLAttribute* found = xml_->FindAttribute(attribute);
  if (found) {
    findings_->error(found->GetLineNum(), description_, std::move(expected), findings_->got(*found));
  } else {
    error(std::move(expected));
  }
}

std::vector<XmlElement> XmlElement::children() const {
  std::vector<XmlElement> children;
  for (const tinyxml2::XMLElement* child = xml_->FirstChildElement(); child; child = child->NextSiblingElement())
    children.emplace_back(*child, "<" + std::string(child->Name()) + "> of " + owner_, owner_, *findings_);
  return children;
}

std::optional<XmlElement> XmlElement::child(const char* tag) const {
  const tinyxml2::XMLElement* child = xml_->FirstChildElement(tag);
  if (!child) return std::nullopt;
  return XmlElement(*child, "<" + std::string(tag) + "> of " + owner_, owner_, *findings_);
}

void XmlElement::warn_or_refuse_repeated(std::initializer_list<const char*> tags, bool first_counts) const {
  std::map<std::string, const tinyxml2::XMLElement*> seen;
  for (const XmlElement& child : children()) {
    if (!contains(tags, child.tag())) continue;
    const auto [first, is_new] = seen.emplace(child.tag(), &child.xml());
    if (is_new) continue;
    const bool is_alike =
        child.xml().ShallowEqual(first->second) && child.xml().NoChildren() && first->second->NoChildren();
    const std::string expected = "at most one <" + child.tag() + "> is allowed here";
    if (is_alike)
      child.warning(expected + "; the two are identical");
    else if (first_counts)
      child.warning(expected + "; the first one counts, of line " + std::to_string(first->second->GetLineNum()) +
                    ", and this one is ignored");
    else
      child.error(expected);
  }
}

void XmlElement::expect_at_most_one(std::initializer_list<const char*> tags) const {
  warn_or_refuse_repeated(tags, false);
}

void XmlElement::expect_first_counts(std::initializer_list<const char*> tags) const {
  warn_or_refuse_repeated(tags, true);
}

void XmlElement::expect_only(std::initializer_list<const char*> attributes,
                             std::initializer_list<const char*> tags) const {
  for (const tinyxml2::XMLAttribute* a = xml_->FirstAttribute(); a; a = a->Next()) {
    if (!contains(attributes, a->Name()))
      findings_->error(a->GetLineNum(), description_,
                       "unknown attribute, expected " + listed(attributes) + meant(a->Name(), attributes),
                       quoted(a->Name()));
  }
  for (const tinyxml2::XMLNode* node = xml_->FirstChild(); node; node = node->NextSibling()) {
    if (!node->ToText()) continue;
    std::string_view text = node->Value();
    findings_->error(node->GetLineNum(), description_, "no text is expected here", quoted(next_word(text)));
  }
  for (const XmlElement& child : children()) {
    if (!contains(tags, child.tag()))
      child.error("unknown element, expected " + listed(tags) + meant(child.tag(), tags));
  }
}

std::optional<std::string> XmlElement::text(const char* attribute) const {
  const char* value = xml_->Attribute(attribute);
  if (!value) {
    error("attribute '" + std::string(attribute) + "' is missing");
    return std::nullopt;
  }
  return value;
}

std::optional<std::string> XmlElement::name(const char* attribute) const {
  std::optional<std::string> value = text(attribute);
  if (!value) return std::nullopt;
  const bool has_control =
      std::any_of(value->begin(), value->end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; });
  if (value->empty() || value->size() > kLongestName || has_control) {
    attribute_error(attribute, std::string(attribute) + " must be a name of 1 to " + std::to_string(kLongestName) +
                                   " characters without control characters");
    return std::nullopt;
  }
  return value;
}

std::optional<std::vector<double>> XmlElement::numbers(const char* attribute, std::size_t count,
                                                       const NumberRange& range) const {
  const std::optional<std::string> value = text(attribute);
  if (!value) return std::nullopt;
  std::optional<std::vector<double>> numbers = parse_numbers(*value, count);
  if (!numbers || numbers->size() != count) {
    attribute_error(attribute, std::string(attribute) + " must be " +
                                   (count == 1 ? "a finite number" : std::to_string(count) + " finite numbers"));
    return std::nullopt;
  }
  if (!std::all_of(numbers->begin(), numbers->end(), [&](double number) { return range.holds(number); })) {
    attribute_error(attribute, std::string(attribute) + " must be " + range.text);
    return std::nullopt;
  }
  return numbers;
}

std::optional<std::vector<double>> XmlElement::all_numbers(const char* attribute, std::size_t most) const {
  const std::optional<std::string> value = text(attribute);
  if (!value) return std::nullopt;
  std::optional<std::vector<double>> numbers = parse_numbers(*value, most);
  if (!numbers)
    attribute_error(attribute, std::string(attribute) + " must be at most " + std::to_string(most) + " finite numbers");
  return numbers;
}

std::optional<double> XmlElement::number(const char* attribute, const NumberRange& range) const {
  const std::optional<std::vector<double>> values = numbers(attribute, 1, range);
  if (!values) return std::nullopt;
  return values->front();
}

double XmlElement::number(const char* attribute, const NumberRange& range, double fallback) const {
  return has(attribute) ? number(attribute, range).value_or(fallback) : fallback;
}

std::optional<int> XmlElement::integer(const char* attribute, int least, int most, const char* alternative) const {
  const std::optional<std::string> value = text(attribute);
  if (!value) return std::nullopt;
  std::string_view rest = *value;
  const std::string_view word = next_word(rest);
  int result = 0;
  const std::from_chars_result parsed = std::from_chars(word.data(), word.data() + word.size(), result);
  if (parsed.ec != std::errc() || parsed.ptr != word.data() + word.size() || !next_word(rest).empty() ||
      result < least || result > most) {
    attribute_error(attribute, std::string(attribute) + " must be a whole number from " + std::to_string(least) +
                                   " to " + std::to_string(most) + alternative);
    return std::nullopt;
  }
  return result;
}

std::optional<Vector3> XmlElement::vector(const char* attribute) const {
  const std::optional<std::vector<double>> values = numbers(attribute, 3, kModerate);
  if (!values) return std::nullopt;
  return Vector3((*values)[0], (*values)[1], (*values)[2]);
}

Vector3 XmlElement::vector(const char* attribute, const Vector3& fallback) const {
  return has(attribute) ? vector(attribute).value_or(fallback) : fallback;
}

std::optional<Vector3> XmlElement::direction(const char* attribute) const {
  const std::optional<Vector3> value = vector(attribute);
  if (!value) return std::nullopt;
  const Vector3 unit = value->stableNormalized();
  if (!(std::abs(unit.norm() - 1) < 1e-6)) {  // zero, or so small that its direction is lost
    attribute_error(attribute, std::string(attribute) + " must not be zero");
    return std::nullopt;
  }
  return unit.normalized();
}

std::optional<TimeFunction> XmlElement::function(const char* attribute) const {
  const std::optional<std::string> value = text(attribute);
  if (!value) return std::nullopt;
  if (names_column(*value)) return read_trajectory(*this, attribute, *value);
  try {
    const TimeFunction function = TimeFunction::parse(*value);
    if (std::isfinite(function(0))) return function;
    attribute_error(attribute, std::string(attribute) + " must be finite at t = 0");
  } catch (const std::invalid_argument& problem) {
    // The message repeats the value and may itself be long.
    const tinyxml2::XMLAttribute& found = *xml_->FindAttribute(attribute);
    findings_->error(found.GetLineNum(), description_, std::string(attribute) + " is not a function of time",
                     problem.what() + findings_->origin(found));
  }
  return std::nullopt;
}

}  // namespace flexarm::scene
