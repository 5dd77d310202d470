#pragma once
/// Expressions of named numbers, as muParser reads them.

#include <string>
#include <string_view>

#include <muParser.h>

namespace flexarm {

/// "'text'", shortened for messages about expressions and tables.
std::string quoted_expression(std::string_view text);

/// Has `parser`, which knows all names, compile `text`, an expression with one value, so that its evaluation does not
/// allocate.
/// @returns its value, which need not be finite
/// @throws std::invalid_argument that says what is wrong, at which character, and that `expected` was expected.
double compile_expression(mu::Parser& parser, const std::string& text, std::string_view expected);

}  // namespace flexarm
