#pragma once
/// Named parameters of a scene, and the evaluation of expressions that contain them.

#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <muParser.h>

namespace flexarm::scene {

/// Why an expression has no finite value, as the texts `expected` and `got` of a Diagnostic.
struct ExpressionFault {
  std::string expected, got;
};

/// Named numbers that may occur in expressions.
class ParameterTable {
 public:
  ParameterTable();

  /// Whether the name may occur in expressions, as a parameter, a constant or a function.
  bool knows(const std::string& name) const;
  bool has(const std::string& name) const { return values_.count(name) > 0; }
  bool is_empty() const { return values_.empty(); }
  /// `name` must be an identifier and not known yet.
  void add(const std::string& name, double value);
  /// Returns the parameters' names as "length, payload", in the order in which they were added; shortened if they are
  /// many.
  std::string names() const { return joined(names_); }

  std::variant<double, ExpressionFault> evaluate(const std::string& expression);
  /// Returns the first unknown name in an expression, or an empty text if all names are known.
  std::string unknown_in(std::string_view expression) const;
  /// Returns the parameters that occur in an expression, with their values, as " with length = 2, payload = 120". Empty
  /// if there are none.
  std::string values_in(std::string_view expression) const;

 private:
  static std::string joined(const std::vector<std::string>& words);

  mu::Parser parser_;
  std::vector<std::string> names_;
  std::map<std::string, double> values_;
};

/// Whether the name is a letter or '_', followed by letters, digits and '_'.
bool is_identifier(std::string_view name);

}  // namespace flexarm::scene
