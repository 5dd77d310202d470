#include "scene/parameters.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/parameter_table.h"
#include "scene/xacro.h"
#include "scene/xml_element.h"

namespace flexarm::scene {
namespace {

constexpr std::string_view kOpen = "${";

/// Returns "from 0 to 300", "at least 0" or "at most 300". The parameter must have a bound.
std::string range_text(const ParameterDescription& parameter) {
  if (!parameter.min) return fmt::format("at most {}", *parameter.max);
  return parameter.max ? fmt::format("from {} to {}", *parameter.min, *parameter.max)
                       : fmt::format("at least {}", *parameter.min);
}

bool is_in_range(const ParameterDescription& parameter) {
  return (!parameter.min || parameter.value >= *parameter.min) && (!parameter.max || parameter.value <= *parameter.max);
}

/// An element whose attributes can be changed, and its XmlElement, which reads it and records findings about it.
struct WritableElement {
  tinyxml2::XMLElement& xml;
  XmlElement element;
};

std::vector<WritableElement> children(const WritableElement& target) {
  std::vector<WritableElement> children;
  tinyxml2::XMLElement* child = target.xml.FirstChildElement();
  for (const XmlElement& element : target.element.children()) {
    children.push_back({*child, element});
    child = child->NextSiblingElement();
  }
  return children;
}

/// Reads the parameters of a scene, then replaces expressions by numbers.
class Expansion {
 public:
  Expansion(const ParameterValues& given, Findings& findings) : given_(given), findings_(findings) {}

  void declare(const WritableElement& target);
  void expand(const WritableElement& target);
  /// Records an error for each given value without a parameter of that name.
  void check_given() const;

  std::vector<ParameterDescription> take() { return std::move(parameters_); }

 private:
  /// Expands all attributes but the one named `but`. Returns false if an expression has no value; an error about it is
  /// recorded.
  bool expand_attributes(const WritableElement& target, std::string_view but = "");
  bool expand_attribute(const WritableElement& target, const tinyxml2::XMLAttribute& attribute);
  /// Returns the text with its expressions replaced by numbers, and appends the expressions to `expressions`. Returns
  /// nothing if one has no value.
  std::optional<std::string> replaced(const XmlElement& element, int line, std::string_view text,
                                      std::string& expressions);
  std::optional<double> evaluate(const XmlElement& element, int line, const std::string& expression);
  /// Reads a <parameter>. Returns nothing if it has an error.
  std::optional<ParameterDescription> read(const WritableElement& target);
  bool is_good_name(const XmlElement& parameter, const std::string& name);
  void settle_value(const XmlElement& element, ParameterDescription& parameter) const;

  const ParameterValues& given_;
  Findings& findings_;
  ParameterTable table_;
  std::vector<ParameterDescription> parameters_;
  std::map<std::string, int> lines_;  // by name: the line that declares it
  std::set<std::string> broken_;      // names of parameters with errors
  std::size_t expression_count_ = 0;
  bool is_given_up_ = false;  // an error that concerns all further expressions is recorded
};

// ---------------------------------------------------------------- expressions

std::optional<double> Expansion::evaluate(const XmlElement& element, int line, const std::string& expression) {
  if (++expression_count_ > kMostExpressions) {
    findings_.error(line, element.description(), fmt::format("a scene may have {} expressions", kMostExpressions));
    is_given_up_ = true;
    return std::nullopt;
  }
  const std::string unknown = table_.unknown_in(expression);
  if (broken_.count(unknown) > 0) return std::nullopt;  // an error about this parameter is recorded already
  if (!unknown.empty() && lines_.empty()) {
    refuse_property(element, line, unknown, "${" + expression + "}");
    is_given_up_ = true;
    return std::nullopt;
  }
  const std::variant<double, ExpressionFault> value = table_.evaluate(expression);
  if (const auto* fault = std::get_if<ExpressionFault>(&value)) {
    findings_.error(line, element.description(), fault->expected, fault->got);
    return std::nullopt;
  }
  return std::get<double>(value);
}

std::optional<std::string> Expansion::replaced(const XmlElement& element, int line, std::string_view text,
                                               std::string& expressions) {
  std::string out;
  for (std::size_t open = text.find(kOpen); open != std::string_view::npos; open = text.find(kOpen)) {
    const std::size_t begin = open + kOpen.size(), end = text.find('}', begin);
    if (end == std::string_view::npos) {
      findings_.error(line, element.description(), "'${' must be closed by '}'", quoted(text.substr(open)));
      return std::nullopt;
    }
    const std::string expression(text.substr(begin, end - begin));
    if (expression.find_first_not_of(" \t\r\n") == std::string::npos) {
      findings_.error(line, element.description(), "an expression must be between '${' and '}'",
                      quoted(text.substr(open, end + 1 - open)));
      return std::nullopt;
    }
    const std::optional<double> value = evaluate(element, line, expression);
    if (!value) return std::nullopt;
    out += text.substr(0, open);
    out += fmt::format("{}", *value);  // the shortest number that has the same bits
    expressions += expression + ' ';
    text.remove_prefix(end + 1);
  }
  return out + std::string(text);
}

bool Expansion::expand_attribute(const WritableElement& target, const tinyxml2::XMLAttribute& attribute) {
  const std::string text = attribute.Value();
  if (text.find(kOpen) == std::string::npos) return true;
  if (is_given_up_) return false;
  std::string expressions;
  const std::optional<std::string> value = replaced(target.element, attribute.GetLineNum(), text, expressions);
  if (!value) return false;
  target.xml.SetAttribute(attribute.Name(), value->c_str());
  findings_.note_origin(attribute, " of " + quoted(text) + table_.values_in(expressions));
  return true;
}

bool Expansion::expand_attributes(const WritableElement& target, std::string_view but) {
  bool are_good = true;
  for (const tinyxml2::XMLAttribute* a = target.xml.FirstAttribute(); a; a = a->Next())
    if (a->Name() != but && !expand_attribute(target, *a)) are_good = false;
  return are_good;
}

void Expansion::expand(const WritableElement& target) {
  const std::string tag = target.element.tag();
  if (is_of_xacro(tag) || is_for_others(tag)) return;
  expand_attributes(target);
  const char* name = target.xml.Attribute("name");
  const XmlElement owner = name                  ? target.element.with_name(name)
                           : tag == "simulation" ? target.element.with_owner(tag)
                                                 : target.element;
  for (const WritableElement& child : children({target.xml, owner})) expand(child);
}

// ---------------------------------------------------------------- parameters

bool Expansion::is_good_name(const XmlElement& parameter, const std::string& name) {
  if (const auto [first, is_new] = lines_.emplace(name, parameter.line()); !is_new) {
    parameter.attribute_error("name", "name is taken, by line " + std::to_string(first->second));
  } else if (!is_identifier(name)) {
    parameter.attribute_error("name", "name must be a letter or '_', then letters, digits and '_'");
  } else if (name.size() > kLongestParameterName) {
    parameter.attribute_error("name", fmt::format("name has at most {} characters", kLongestParameterName));
  } else if (table_.knows(name)) {
    parameter.attribute_error("name", "name must not be that of a function or constant of expressions");
  } else {
    return true;
  }
  return false;
}

void Expansion::settle_value(const XmlElement& element, ParameterDescription& parameter) const {
  if (parameter.min && parameter.max && *parameter.min > *parameter.max)
    return element.attribute_error("min", fmt::format("min must be <= max, {}", *parameter.max));
  const auto given = given_.find(parameter.name);
  if (given == given_.end()) {
    if (!is_in_range(parameter)) element.attribute_error("value", "value must be " + range_text(parameter));
    return;
  }
  parameter.value = given->second;
  if (!std::isfinite(parameter.value) || !is_in_range(parameter))
    element.error(
        "the value that is set must be " + (parameter.min || parameter.max ? range_text(parameter) : "a finite number"),
        fmt::format("'{}'", parameter.value));
}

std::optional<ParameterDescription> Expansion::read(const WritableElement& target) {
  const XmlElement& element = target.element;
  const std::size_t errors = findings_.error_count();
  element.expect_only({"name", "value", "min", "max"});
  if (!expand_attributes(target, "name")) return std::nullopt;
  ParameterDescription parameter;
  parameter.name = element.text("name").value_or("");
  parameter.value = element.number("value", kAnyNumber).value_or(0);
  if (element.has("min")) parameter.min = element.number("min", kAnyNumber);
  if (element.has("max")) parameter.max = element.number("max", kAnyNumber);
  if (findings_.error_count() == errors) settle_value(element, parameter);
  if (findings_.error_count() > errors) return std::nullopt;
  return parameter;
}

void Expansion::declare(const WritableElement& target) {
  const std::optional<std::string> name = target.element.name("name");
  if (!name || !is_good_name(target.element, *name)) return;
  const std::optional<ParameterDescription> parameter = read({target.xml, target.element.with_name(*name)});
  if (!parameter) {
    broken_.insert(*name);
    return;
  }
  table_.add(*name, parameter->value);
  parameters_.push_back(*parameter);
}

void Expansion::check_given() const {
  for (const auto& [name, value] : given_)
    if (lines_.count(name) == 0)
      findings_.error(
          0, "scene",
          lines_.empty() ? "it has no <parameter>" : fmt::format("a parameter must be one of {}", table_.names()),
          quoted(name));
}

}  // namespace

std::vector<ParameterDescription> expand_parameters(tinyxml2::XMLElement& robot, const ParameterValues& given,
                                                    Findings& findings) {
  const char* name = robot.Attribute("name");
  const WritableElement target{robot, XmlElement(robot, "", "", findings).with_name(name ? name : "")};
  std::vector<WritableElement> declarations;
  for (const WritableElement& child : children(target))
    if (child.element.tag() == "parameter") declarations.push_back(child);
  if (declarations.size() > kMostParameters) {
    target.element.error(fmt::format("a scene has at most {} parameters", kMostParameters));
    return {};
  }
  Expansion expansion(given, findings);
  for (const WritableElement& declaration : declarations) expansion.declare(declaration);
  expansion.check_given();
  if (findings.error_count() == 0) expansion.expand(target);
  return expansion.take();
}

}  // namespace flexarm::scene
