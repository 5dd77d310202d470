#pragma once
/// Lets Ctrl-C interrupt long work in C++.

#include <chrono>

namespace flexarm::python {

/// Checks for signals from time to time, in code that does not hold the GIL.
class SignalClock {
 public:
  /// Returns true if a Python exception is pending; then the work must end.
  bool is_interrupted();

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kPeriod{100};
  Clock::time_point next_ = Clock::now() + kPeriod;
  bool is_interrupted_ = false;
};

}  // namespace flexarm::python
