#pragma once
/// Ctrl-C in long work.

#include <chrono>

namespace flexarm::python {

/// Lets Python see to signals now and then, from where its lock is not held.
class SignalClock {
 public:
  /// True: an exception of Python's is pending; the work is to end.
  bool is_interrupted();

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kPeriod{100};
  Clock::time_point next_ = Clock::now() + kPeriod;
  bool is_interrupted_ = false;
};

}  // namespace flexarm::python
