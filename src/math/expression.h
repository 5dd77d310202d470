#pragma once
/// Compiles expressions for muParser.

#include <string>
#include <string_view>

#include <muParser.h>

namespace flexarm {

/// Returns the text in quotes, shortened for messages.
std::string quoted_expression(std::string_view text);

/// Compiles `text`, an expression with one value, in `parser`, in which all names must be defined. Later evaluations do
/// not allocate.
/// @returns the expression's value, which may not be finite
/// @throws std::invalid_argument for an invalid expression; the message says what is wrong, at which character, and
/// that `expected` was expected
double compile_expression(mu::Parser& parser, const std::string& text, std::string_view expected);

}  // namespace flexarm
