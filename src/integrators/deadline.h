#pragma once
/// The wall time at which a step must end.

#include <cassert>
#include <chrono>

namespace flexarm {

/// The wall time that a step may take, for all schemes that try it. It starts when this object is made.
class Deadline {
 public:
  /// @param seconds  after which it has passed [s]; 0: it never does
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
