#pragma once
/// Computes how many steps are due, from the elapsed wall time.

#include <cstdint>

namespace flexarm::node {

/// Keeps simulated time at a fixed ratio to wall time. A small backlog is caught up. The part of a backlog beyond
/// `max_catch_up` is dropped and counted: a simulation that is too slow runs slowly, instead of hanging.
class Pacer {
 public:
  /// @param step              [s]
  /// @param real_time_factor  simulated time / wall time; 0: as fast as possible, so that a step is always due
  /// @param max_catch_up      largest backlog in wall time [s]; at least two steps
  Pacer(double step, double real_time_factor, double max_catch_up);

  /// Changes the constructor's parameters for future steps. Keeps the backlog and the count of dropped steps.
  void set_pace(double step, double real_time_factor, double max_catch_up);
  /// Adds elapsed wall time [s].
  void elapse(double wall_time);
  bool step_due() const { return as_fast_as_possible() || backlog_ >= step_; }
  /// Wall time since the next step became due [s]; negative: time until then. Undefined if as_fast_as_possible().
  double lateness() const { return (backlog_ - step_) / real_time_factor_; }
  bool as_fast_as_possible() const { return real_time_factor_ == 0; }
  void step_done();
  /// Drops the backlog without counting it, for example after a pause.
  void clear_backlog() { backlog_ = 0; }

  /// Number of steps that were dropped.
  std::uint64_t overruns() const { return overruns_; }

 private:
  double step_, real_time_factor_;
  double max_backlog_;  ///< simulated time [s]
  double backlog_ = 0;  ///< simulated time that is due [s]
  std::uint64_t overruns_ = 0;
};

}  // namespace flexarm::node
