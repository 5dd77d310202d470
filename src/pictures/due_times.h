#pragma once
/// Chooses the instants of a run that a picture of it shows.

#include <algorithm>
#include <cmath>

#include "flexarm/simulation/simulation.h"

namespace flexarm::pictures {

/// Times at equal distances from the first instant on: the first one + n / rate, so that the round-off of many periods
/// does not add up.
class DueTimes {
 public:
  /// @param rate  instants per second of simulated time
  explicit DueTimes(double rate) : rate_(rate) {}

  bool is_due(double time) const { return count_ == 0 || time >= first_ + (count_ - kRoundOff) / rate_; }
  /// Whether an instant is due now. Half a step early is nearer than half a step late.
  bool is_due(const Simulation& simulation) const { return is_due(simulation.time() + 0.5 * simulation.step_size()); }
  /// Call this for each instant that is shown. Times that have gone by without an instant are left out.
  void note(double time) {
    if (count_ == 0) first_ = time;
    count_ = std::max(count_, std::floor((time - first_) * rate_)) + 1;
  }
  /// Doubles the distance.
  void thin_out() {
    rate_ /= 2;
    count_ = std::floor(count_ / 2);
  }

 private:
  static constexpr double kRoundOff = 1e-6;  ///< of times, in periods

  double rate_;       ///< [1/s]
  double first_ = 0;  ///< time of the first instant [s]
  double count_ = 0;  ///< so many periods after the first instant the next one is due; 0: there is none yet
};

}  // namespace flexarm::pictures
