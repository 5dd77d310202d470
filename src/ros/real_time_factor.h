#pragma once
/// Measures how fast the simulation really goes.

#include <chrono>
#include <utility>

namespace flexarm::node {

/// Simulated time per wall time. Steps come in bursts, so a measurement needs some time: a call less than kShortest
/// after the last measurement returns the last result.
class RealTimeFactor {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kShortest{50};

  explicit RealTimeFactor(Clock::time_point now) : wall_time_(now) {}

  /// The factor since the last measurement; 0 while paused, and in the first call after a pause.
  /// @param simulated_time  which no reset sets back [s]
  double measure(double simulated_time, Clock::time_point now, bool paused) {
    const bool was_paused = std::exchange(paused_, paused);
    const Clock::duration elapsed = now - wall_time_;
    if (paused || was_paused) {
      factor_ = 0;
    } else if (elapsed < kShortest) {
      return factor_;
    } else {
      factor_ = (simulated_time - simulated_time_) / std::chrono::duration<double>(elapsed).count();
    }
    simulated_time_ = simulated_time;
    wall_time_ = now;
    return factor_;
  }

 private:
  Clock::time_point wall_time_;
  double simulated_time_ = 0, factor_ = 0;
  bool paused_ = false;
};

}  // namespace flexarm::node
