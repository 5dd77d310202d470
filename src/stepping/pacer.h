#pragma once
/// Turns elapsed wall time into steps that are due.

#include <cstdint>

namespace flexarm::node {

/// Keeps simulated time at a fixed ratio to wall time. A backlog is made up as long as it is small; what exceeds
/// `max_catch_up` is dropped and counted, so that a simulation that is too slow runs slowly instead of hanging.
class Pacer {
 public:
  /// @param step              [s]
  /// @param real_time_factor  simulated per wall time; 0: as fast as possible, a step is always due
  /// @param max_catch_up      largest backlog, wall time [s]; at least one step is always kept
  Pacer(double step, double real_time_factor, double max_catch_up);

  /// Of the steps to come, as of the constructor; what was due or dropped stays.
  void set_pace(double step, double real_time_factor, double max_catch_up);
  /// Wall time has passed [s].
  void elapse(double wall_time);
  bool step_due() const { return as_fast_as_possible() || backlog_ >= step_; }
  /// Since the next step has been due, wall time; negative: until it is [s]. Not where that is always.
  double lateness() const { return (backlog_ - step_) / real_time_factor_; }
  bool as_fast_as_possible() const { return real_time_factor_ == 0; }
  void step_done();
  /// Nothing is due any more, and nothing counts as dropped: the simulation was paused.
  void clear_backlog() { backlog_ = 0; }

  /// Steps dropped so far.
  std::uint64_t overruns() const { return overruns_; }

 private:
  double step_, real_time_factor_;
  double max_backlog_;  ///< simulated time [s]
  double backlog_ = 0;  ///< simulated time that is due [s]
  std::uint64_t overruns_ = 0;
};

}  // namespace flexarm::node
