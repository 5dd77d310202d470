#pragma once
/// Finds the times at which an expression of t has jumps and kinks.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <muParser.h>

namespace flexarm {

constexpr std::size_t kMostCorners = 10'000;

/// An expression that records, with each evaluation, which branches its comparisons, signs, absolute values, minima,
/// maxima and roundings take.
class TracedExpression {
 public:
  /// @param text  a valid expression, see compile_expression()
  explicit TracedExpression(const std::string& text);
  TracedExpression(const TracedExpression&) = delete;
  TracedExpression& operator=(const TracedExpression&) = delete;

  struct Value {
    double time = 0, value = 0;
    std::uint64_t branches = 0;     ///< hash of all branches taken; differs between the two sides of a switch
    std::vector<double> arguments;  ///< a branch switches when its argument passes through zero
  };
  Value at(double time);

 private:
  double t_ = 0;
  mu::Parser parser_;
};

/// Returns the times within (begin, end) at which the expression or its derivative jumps, in increasing order, accurate
/// to the resolution of double numbers; at most 10,000. Compares branches at 20,000 times, and between these where an
/// argument seems to touch zero. Searches for jumps and kinks without a branch, as in acos(cos(t)), by second
/// differences at the same times.
std::vector<double> expression_corners(const std::string& text, double begin, double end);

}  // namespace flexarm
