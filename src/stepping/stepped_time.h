#pragma once
/// Simulated time that resets of the simulation do not set back.

#include <cstdint>

namespace flexarm::node {

/// Counts steps, so that rounding errors do not accumulate. The step size may change.
class SteppedTime {
 public:
  /// @param step  [s]
  explicit SteppedTime(double step) : step_(step) {}

  void advance(std::uint64_t steps = 1) { steps_ += steps; }
  /// Sets the size of future steps [s].
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
