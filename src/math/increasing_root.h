#pragma once
/// Roots of scalar functions that grow.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace flexarm {

struct ValueAndSlope {
  double value = 0, slope = 0;
};

/// The root of a function that never falls and has one, whatever kinks it has: Newton's method from `guess`, between
/// the bounds that the signs seen so far give, which are halved where it does not come forward. `evaluate(x)` returns a
/// ValueAndSlope, last of all at the root but for round-off; `scale`: a length on the axis, first step where there is
/// no slope.
template <class Evaluate>
double increasing_root(const Evaluate& evaluate, double guess, double scale) {
  assert(!(scale <= 0) && "a length");
  constexpr int kMostSteps = 300;  // far more than bisection from any bounds takes
  constexpr double kRoundOff = std::numeric_limits<double>::epsilon();
  double low = -std::numeric_limits<double>::infinity(), high = -low, x = guess, before = high;
  for (int n = 0; n < kMostSteps; ++n) {
    const ValueAndSlope f = evaluate(x);
    if (f.value == 0 || !std::isfinite(f.value)) return x;
    (f.value < 0 ? low : high) = x;
    const bool advances = std::abs(f.value) <= 0.5 * before;
    before = std::abs(f.value);
    const bool has_both = std::isfinite(low) && std::isfinite(high);
    double next = x - f.value / f.slope;
    const bool is_inside = f.slope > 0 && next >= low && next <= high;  // on a bound only by round-off
    if (!is_inside || (has_both && !advances))
      next = has_both ? low + 0.5 * (high - low) : x - std::copysign(std::ldexp(scale, n), f.value);
    if (std::abs(next - x) <= kRoundOff * std::abs(x) || (has_both && high - low <= kRoundOff * std::abs(x)))
      return next;
    x = next;
  }
  return x;
}

}  // namespace flexarm
