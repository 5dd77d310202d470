#pragma once
/// Simulated time that no reset sets back.

#include <cstdint>

namespace flexarm::node {

/// Counts steps, so that no rounding accumulates; their size may change.
class SteppedTime {
 public:
  /// @param step  [s]
  explicit SteppedTime(double step) : step_(step) {}

  void advance(std::uint64_t steps = 1) { steps_ += steps; }
  /// Of the steps to come [s].
  void set_step(double step) {
    begin_ = seconds();
    steps_ = 0;
    step_ = step;
  }
  double seconds() const { return begin_ + static_cast<double>(steps_) * step_; }

 private:
  double begin_ = 0, step_;
  std::uint64_t steps_ = 0;  ///< since `begin_`
};

}  // namespace flexarm::node
