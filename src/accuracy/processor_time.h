#pragma once
/// The clock by which computing is timed: other programs on the machine do not count.

#include <ctime>

namespace flexarm {

/// Of the calling thread, from some beginning [s].
inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace flexarm
