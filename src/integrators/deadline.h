#pragma once
/// A limit for the wall time of a step.

#include <cassert>
#include <chrono>

namespace flexarm {

/// The wall time that all attempts at a step may take together. It starts when this object is constructed.
class Deadline {
 public:
  /// @param seconds  duration [s]; 0: unlimited
  explicit Deadline(double seconds) : seconds_(seconds) {
    assert(seconds >= 0);
    if (seconds_ > 0) begin_ = Clock::now();
  }
  bool has_passed() const {
    return seconds_ > 0 && std::chrono::duration<double>(Clock::now() - begin_).count() > seconds_;
  }

 private:
  using Clock = std::chrono::steady_clock;
  double seconds_;
  Clock::time_point begin_;
};

}  // namespace flexarm
