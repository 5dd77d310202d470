#include "slowness_warning.h"

#include <ros/console.h>

#include <string>

namespace flexarm::node {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr double kPeriod = 10;  ///< least wall time between warnings [s]

}  // namespace

void SlownessWarning::note(double seconds, double time, const StepResult& result) {
  if (seconds <= slowest_.seconds) return;
  slowest_ = {seconds, time, {}};
  slowest_.counts.add(result);
}

void SlownessWarning::warn_if_slow(double step) {
  if (run_.overruns == warned_overruns_) return;
  const SteadyClock::time_point now = SteadyClock::now();
  if (warned_overruns_ > 0 && std::chrono::duration<double>(now - last_warning_).count() < kPeriod) return;
  const std::string recoveries = recoveries_text(slowest_.counts);
  ROS_WARN(
      "slower than real_time_factor, simulated time lags behind: %lu steps of %g s dropped; the slowest step took "
      "%.2g s, to t = %g s: %s",
      run_.overruns - warned_overruns_, step, slowest_.seconds, slowest_.time,
      recoveries.empty() ? "the scene is too large, or the processor is busy" : recoveries.c_str());
  warned_overruns_ = run_.overruns;
  last_warning_ = now;
  slowest_ = {};
}

}  // namespace flexarm::node
