#pragma once
/// Expressions of t that tell which of their branches they take.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <muParser.h>

namespace flexarm {

constexpr std::size_t kMostCorners = 10'000;

/// An expression whose comparisons, signs, absolute values, extremes and roundings are written down as it is evaluated.
class TracedExpression {
 public:
  /// @param text  which has been compiled before
  explicit TracedExpression(const std::string& text);
  TracedExpression(const TracedExpression&) = delete;
  TracedExpression& operator=(const TracedExpression&) = delete;

  struct Value {
    double time = 0, value = 0;
    std::uint64_t branches = 0;     ///< of all that was written down: another one on each side of a corner
    std::vector<double> arguments;  ///< of what switches where one of these goes through zero
  };
  Value at(double time);

 private:
  double t_ = 0;
  mu::Parser parser_;
};

/// Increasing times within (begin, end) at which the expression or its derivative jumps, to the resolution of times.
/// Branches are compared at 20,000 times and where their arguments look as if they touched zero between these; jumps
/// and kinks without a branch, as in acos(cos(t)), are looked for by second differences at the same times. At most
/// 10,000.
std::vector<double> expression_corners(const std::string& text, double begin, double end);

}  // namespace flexarm
