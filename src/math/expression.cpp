#include "math/expression.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "flexarm/math/near_names.h"

namespace flexarm {
namespace {

constexpr std::size_t kLongestExpression = 2000;  // characters; far above what anyone writes by hand
constexpr std::size_t kLongestReason = 200;

/// Returns the position of an '=' that is an assignment. Assignments are refused, since with them an expression could
/// change the variables that it uses.
std::size_t find_assignment(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
    } else if (i == 0 || std::string_view("<>!").find(text[i - 1]) == std::string_view::npos) {
      return i;
    }
  }
  return std::string_view::npos;
}

std::invalid_argument expression_error(std::string_view text, std::size_t position, const std::string& reason,
                                       std::string_view expected) {
  return std::invalid_argument(fmt::format("expression {}, at character {}: {}; expected {}", quoted_expression(text),
                                           position + 1, reason, expected));
}

/// Returns "; did you mean 'NAME'?" if a function, variable or constant has nearly this name; else an empty text.
std::string meant_by(const std::string& token, const mu::Parser& parser) {
  std::vector<std::string> names;
  for (const auto& [name, function] : parser.GetFunDef()) names.push_back(name);
  for (const auto& [name, value] : parser.GetVar()) names.push_back(name);
  for (const auto& [name, value] : parser.GetConst()) names.push_back(name);
  return token.size() <= kLongestReason ? suggestion(token, names) : "";
}

}  // namespace

std::string quoted_expression(std::string_view text) {
  constexpr std::size_t kShown = 60;
  if (text.size() <= kShown) return "'" + std::string(text) + "'";
  return "'" + std::string(text.substr(0, kShown)) + "...'";
}

double compile_expression(mu::Parser& parser, const std::string& text, std::string_view expected) {
  if (text.size() > kLongestExpression)
    throw std::invalid_argument(
        fmt::format("expression of {} characters, expected at most {}", text.size(), kLongestExpression));
  const std::size_t assignment = find_assignment(text);
  if (assignment != std::string::npos) throw expression_error(text, assignment, "assignment (== compares)", expected);
  try {
    parser.SetExpr(text);
    const double value = parser.Eval();
    if (parser.GetNumResults() == 1) return value;
  } catch (const mu::Parser::exception_type& error) {
    const std::size_t position = error.GetPos() < 0 ? 0 : static_cast<std::size_t>(error.GetPos());
    const std::string meant = error.GetCode() == mu::ecUNASSIGNABLE_TOKEN ? meant_by(error.GetToken(), parser) : "";
    throw expression_error(text, std::min(position, text.size()), error.GetMsg().substr(0, kLongestReason) + meant,
                           expected);
  }
  throw expression_error(text, text.find(','), "several values separated by commas", expected);
}

}  // namespace flexarm
