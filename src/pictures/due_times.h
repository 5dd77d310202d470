#pragma once
/// Chooses the instants of a run that a picture of it shows.

#include <algorithm>
#include <limits>

#include "flexarm/simulation/simulation.h"

namespace flexarm::pictures {

/// Times at equal distances, from the first instant on.
class DueTimes {
 public:
  /// @param rate  instants per second of simulated time
  explicit DueTimes(double rate) : period_(1 / rate) {}

  bool is_due(double time) const { return time >= next_ - kRoundOff * period_; }
  /// Whether an instant is due now. Half a step early is nearer than half a step late.
  bool is_due(const Simulation& simulation) const { return is_due(simulation.time() + 0.5 * simulation.step_size()); }
  /// Call this for each instant that is shown.
  void note(double time) { next_ = is_begun() ? std::max(next_ + period_, time + 0.5 * period_) : time + period_; }
  /// Doubles the distance.
  void thin_out() { period_ *= 2; }

 private:
  static constexpr double kRoundOff = 1e-9;  ///< of sums of periods

  bool is_begun() const { return next_ > -std::numeric_limits<double>::infinity(); }

  double period_, next_ = -std::numeric_limits<double>::infinity();  ///< [s]
};

}  // namespace flexarm::pictures
