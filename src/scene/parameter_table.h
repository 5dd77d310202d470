#pragma once
/// Parameters of a scene by their names, and numbers that are made of them.

#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <muParser.h>

namespace flexarm::scene {

/// Why an expression has no finite value, as two parts of a finding.
struct ExpressionFault {
  std::string expected, got;
};

/// Numbers that expressions may name.
class ParameterTable {
 public:
  ParameterTable();

  /// Whether expressions know the name: a parameter's, a constant's or a function's.
  bool knows(const std::string& name) const;
  bool has(const std::string& name) const { return values_.count(name) > 0; }
  bool is_empty() const { return values_.empty(); }
  /// `name` must be an identifier and not known yet.
  void add(const std::string& name, double value);
  /// "length, payload", in the order in which they were added; shortened where there are many.
  std::string names() const { return joined(names_); }

  std::variant<double, ExpressionFault> evaluate(const std::string& expression);
  /// The first name in an expression that is not known; empty if all are.
  std::string unknown_in(std::string_view expression) const;
  /// " with length = 2, payload = 120": those that occur in an expression; empty where none does.
  std::string values_in(std::string_view expression) const;

 private:
  static std::string joined(const std::vector<std::string>& words);

  mu::Parser parser_;
  std::vector<std::string> names_;
  std::map<std::string, double> values_;
};

/// A letter or '_', then letters, digits and '_'.
bool is_identifier(std::string_view name);

}  // namespace flexarm::scene
