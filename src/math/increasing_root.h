#pragma once
/// Finds roots of increasing scalar functions.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace flexarm {

struct ValueAndSlope {
  double value = 0, slope = 0;
};

/// Returns the root of a nondecreasing function, which must have one. The function may have kinks. Uses Newton's method
/// from `guess`, within the bounds that are known from the signs of previous values, and bisection if Newton's method
/// does not advance. `evaluate(x)` returns a ValueAndSlope; its last call is at the root, up to round-off. `scale`:
/// length of the first step if the slope is zero; later ones double.
template <class Evaluate>
double increasing_root(const Evaluate& evaluate, double guess, double scale) {
  assert(!(scale <= 0) && "a length");
  constexpr int kMostSteps = 300;  // far more than bisection needs from any bounds
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
    const bool is_inside = f.slope > 0 && next >= low && next <= high;  // equal to a bound only by round-off
    if (!is_inside || (has_both && !advances))
      next = has_both ? low + 0.5 * (high - low) : x - std::copysign(std::ldexp(scale, n), f.value);
    if (std::abs(next - x) <= kRoundOff * std::abs(x) || (has_both && high - low <= kRoundOff * std::abs(x)))
      return next;
    x = next;
  }
  return x;
}

}  // namespace flexarm
