#pragma once
/// Computes the times within a step at which the equations change. (docs/notes/accuracy.md 4)

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm {

/// Stands for events that do not happen in the step.
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Fraction of a step at which friction is assumed to stop a coordinate, if the time of the stop is unknown.
constexpr double kUnknownStop = 0.5;

/// The fraction of a step at which a quantity first crosses `border` on its way from `begin` to `end`; kNever if both
/// ends are on one side. The rate is assumed to change linearly; `start` is the initial rate times the step.
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

/// The first event in a step. Events before the fraction `behind` do not count. Stops by friction and kinks of forces
/// do not count before `stop_behind`: a stop by friction leaves no error of the velocity, a kink only a small one.
struct FirstEvent {
  double behind = 0, stop_behind = 0;
  double fraction = kNever;  ///< of the step, at the first event; kNever: there is none
  double early = 0;          ///< fraction of the step by which touches of bodies count earlier

  void note(double event) {
    if (event > behind && event < fraction) fraction = event;
  }
  void note_stop(double event) {
    if (event > stop_behind) note(event);
  }
  /// For a touch of bodies. Steps end just before it, so that the next one begins with the speed of approach.
  void note_touch(double event) { note(event - early); }
  /// For a kink of a force. Its error grows with the square of the distance of the event from the end of the step.
  void note_kink(double event) {
    if (event < 1 - stop_behind) note_stop(event);
  }
};

}  // namespace flexarm
