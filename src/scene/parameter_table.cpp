#include "scene/parameter_table.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "math/expression.h"
#include "math/pi.h"
#include "scene/findings.h"

namespace flexarm::scene {
namespace {

constexpr std::size_t kMostShown = 20;  // names and values in a message

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool continues_word(char c) {
  return is_letter(c) || (c >= '0' && c <= '9');
}

/// Returns the identifiers of an expression, each once. The "e" of a number such as 1e3 is not an identifier.
std::vector<std::string> identifiers(std::string_view text) {
  std::vector<std::string> found;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    while (end < text.size() && (continues_word(text[end]) || (end > i && text[end] == '.'))) ++end;
    const std::string word(text.substr(i, end - i));
    if (is_identifier(word) && seen.insert(word).second) found.push_back(word);
    i = std::max(end, i + 1);
  }
  return found;
}

}  // namespace

bool is_identifier(std::string_view name) {
  return !name.empty() && is_letter(name[0]) && std::all_of(name.begin(), name.end(), continues_word);
}

ParameterTable::ParameterTable() {
  parser_.DefineConst("pi", kPi);
}

bool ParameterTable::knows(const std::string& name) const {
  return parser_.GetConst().count(name) > 0 || parser_.GetFunDef().count(name) > 0;
}

void ParameterTable::add(const std::string& name, double value) {
  parser_.DefineConst(name, value);
  names_.push_back(name);
  values_.emplace(name, value);
}

std::string ParameterTable::joined(const std::vector<std::string>& words) {
  const std::size_t shown = std::min(words.size(), kMostShown);
  return fmt::format("{}{}", fmt::join(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                     shown < words.size() ? ", ..." : "");
}

std::variant<double, ExpressionFault> ParameterTable::evaluate(const std::string& expression) {
  const std::string shown = quoted("${" + expression + "}") + values_in(expression);
  if (const std::string unknown = unknown_in(expression); !unknown.empty()) {
    const std::string parameters = is_empty() ? "" : " (" + names() + ")";
    return ExpressionFault{quoted(unknown) + " is not a parameter of the scene" + parameters + ", no function, nor pi",
                           shown};
  }
  double value = 0;
  try {
    value = compile_expression(parser_, expression, "parameters, numbers, functions and pi");
  } catch (const std::invalid_argument& error) {
    return ExpressionFault{"must be an expression", error.what() + values_in(expression)};
  }
  if (std::isfinite(value)) return value;
  return ExpressionFault{"an expression must be a finite number", fmt::format("'{}' of {}", value, shown)};
}

std::string ParameterTable::unknown_in(std::string_view expression) const {
  for (const std::string& name : identifiers(expression))
    if (!knows(name)) return name;
  return "";
}

std::string ParameterTable::values_in(std::string_view expression) const {
  std::vector<std::string> values;
  for (const std::string& name : identifiers(expression))
    if (const auto found = values_.find(name); found != values_.end())
      values.push_back(fmt::format("{} = {}", name, found->second));
  return values.empty() ? "" : " with " + joined(values);
}

}  // namespace flexarm::scene
