#pragma once
/// Finds the times within a step at which the equations change. (docs/notes/accuracy.md 4)

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm {

/// Fraction of a step at which what does not happen in it happens.
constexpr double kNever = std::numeric_limits<double>::infinity();

/// And at which a coordinate is stopped of which nothing but that is known.
constexpr double kUnknownStop = 0.5;

/// The first place on the way from `begin` to `end` at which `border` is crossed; kNever if both are on one side of it.
/// The rate changes linearly; `start` is the way that would be made at the initial rate.
inline double crossing(double begin, double end, double border, double start) {
  if ((begin < border) == (end < border)) return kNever;
  const double bend = end - begin - start, missing = begin - border;  // bend s^2 + start s + missing = 0
  const double root = std::sqrt(std::max(start * start - 4 * bend * missing, 0.0));
  const double sum = -0.5 * (start + std::copysign(root, start));
  double first = kNever;
  for (const double s : {sum / bend, missing / sum})
    if (s >= 0 && s <= 1) first = std::min(first, s);
  return std::isfinite(first) ? first : missing / (begin - end);
}

/// The first of the events in a step that happen behind a fraction of it, and of stops by friction and kinks of forces
/// behind another one: the former leave no error of the velocity, the latter a small one.
struct FirstEvent {
  double behind = 0, stop_behind = 0;
  double fraction = kNever;  ///< kNever: there is none

  void note(double event) {
    if (event > behind && event < fraction) fraction = event;
  }
  void note_stop(double event) {
    if (event > stop_behind) note(event);
  }
  /// Where a force has a kink, which makes an error as the square of how far the end of a step is from it.
  void note_kink(double event) {
    if (event < 1 - stop_behind) note_stop(event);
  }
};

}  // namespace flexarm
