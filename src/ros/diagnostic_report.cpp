#include "diagnostic_report.h"

#include <fmt/format.h>

#include <string>

#include "flexarm/simulation/simulation.h"
#include "run_state.h"

namespace flexarm::node {

using diagnostic_msgs::DiagnosticStatus;

void DiagnosticReport::write(DiagnosticStatus& status) {
  const std::uint64_t new_overruns = run_.overruns - reported_overruns_;
  reported_overruns_ = run_.overruns;
  if (run_.failed()) {
    status.level = DiagnosticStatus::ERROR;
    status.message = run_.failure;
  } else if (new_overruns > 0) {
    status.level = DiagnosticStatus::WARN;
    status.message = fmt::format("slower than real_time_factor: {} steps dropped", new_overruns);
  } else {
    status.level = DiagnosticStatus::OK;
    status.message = run_.paused ? "paused" : "running";
  }
  const auto add = [&](const std::string& what, const std::string& value) {
    status.values.emplace_back();
    status.values.back().key = what;
    status.values.back().value = value;
  };
  add("Time [s]", fmt::format("{:g}", simulation_.time()));
  add("Step [s]", fmt::format("{:g}", simulation_.step_size()));
  add("Scheme", simulation_.scheme());
  add("Steps", std::to_string(run_.steps));
  add("Newton iterations of the last step", std::to_string(run_.last_step.iterations));
  add("Step halvings", std::to_string(run_.counts.halvings));
  add("Recoveries", recoveries_text(run_.counts));
  add("Overruns (steps dropped)", std::to_string(run_.overruns));
  add("Steps whose states were not published", std::to_string(run_.missed));
  add("Steps cut short", std::to_string(run_.cut));
  const auto add_quantiles = [&](const std::string& what, const DurationHistogram& histogram) {
    add(what, fmt::format("50 %: {:.3g}, 99 %: {:.3g}, 99.9 %: {:.3g}, longest: {:.3g}", histogram.quantile(0.5),
                          histogram.quantile(0.99), histogram.quantile(0.999), histogram.largest()));
  };
  add_quantiles("Wall time of a step [s]", run_.step_times);
  add_quantiles("Lateness of its beginning [s]", run_.lateness);
}

}  // namespace flexarm::node
