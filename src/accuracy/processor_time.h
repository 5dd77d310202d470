#pragma once
/// The clock by which computing is timed. It measures processor time, so that other programs on the machine do not
/// count.

#include <ctime>

namespace flexarm {

/// Processor time of the calling thread, from some fixed instant [s].
inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace flexarm
