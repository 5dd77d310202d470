#pragma once
/// Steps of joint coordinates, and slopes of their efforts by differences.

#include "elements/differences.h"
#include "joints/coordinate_step.h"

namespace flexarm::test {

/// A step from `begin` to `end`, without a rate at the beginning.
inline CoordinateStep step_between(double begin, double end, double step) {
  CoordinateStep change;
  change.begin = begin;
  change.end = end;
  change.increment = end - begin;
  change.step = step;
  return change;
}

/// d(effort(change))/d(end) by differences, with a step that is small against `scale`.
template <class Effort>
double slope_by_difference(const Effort& effort, const CoordinateStep& change, double scale) {
  return scalar_difference(
      [&](double h) {
        CoordinateStep moved = change;
        moved.end += h;
        moved.increment += h;
        return effort(moved);
      },
      0.02 * scale);
}

}  // namespace flexarm::test
