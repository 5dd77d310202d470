#pragma once
/// The times at which steps end.

#include <cmath>
#include <limits>

namespace flexarm {

/// Returns `time` + `step` [s] so that the round-off of many steps does not add up. If both are decimal numbers of at
/// most 15 digits, as times and steps that people write, it is the number nearest to the exact sum: the n-th step of
/// 0.001 s from 0 on ends at the number that is written n/1000. Otherwise, if `time` is a multiple of `step` up to
/// round-off, it is the next multiple. Since only the time counts, a run that goes on from any state has the same times
/// as an uninterrupted one.
inline double step_end(double time, double step) {
  constexpr double kPowers[] = {1e15, 1e14, 1e13, 1e12, 1e11, 1e10, 1e9, 1e8, 1e7, 1e6, 1e5, 1e4, 1e3, 1e2, 1e1, 1e0};
  const double* digits = kPowers;  // 15 digits belong to one number only
  while ((std::abs(time) + std::abs(step)) * *digits > 1e15 && *digits > 1) ++digits;
  const double power = *digits;
  const double times = std::nearbyint(time * power), steps = std::nearbyint(step * power);
  if (times / power == time && steps / power == step) return (times + steps) / power;
  const double count = std::nearbyint(time / step);
  const bool is_multiple = std::abs(time - count * step) <= 2 * std::numeric_limits<double>::epsilon() * std::abs(time);
  return is_multiple ? (count + 1) * step : time + step;
}

}  // namespace flexarm
