#include "diagnostics.h"

namespace flexarm::node {

using diagnostic_msgs::DiagnosticStatus;

Diagnostics::Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node, const Simulation& simulation,
                         const RunState& run)
    : simulation_(simulation), run_(run), updater_(node, private_node) {
  updater_.setHardwareID("none");
  updater_.add("simulation", this, &Diagnostics::report);
}

void Diagnostics::publish(bool force) {
  if (force) {
    updater_.force_update();
  } else {
    updater_.update();
  }
}

void Diagnostics::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::uint64_t new_overruns = run_.overruns - reported_overruns_;
  reported_overruns_ = run_.overruns;
  if (run_.failed()) {
    status.summary(DiagnosticStatus::ERROR, run_.failure);
  } else if (new_overruns > 0) {
    status.summaryf(DiagnosticStatus::WARN, "slower than asked for: %lu steps dropped", new_overruns);
  } else {
    status.summary(DiagnosticStatus::OK, run_.paused ? "paused" : "running");
  }
  status.add("Time [s]", simulation_.time());
  status.add("Step [s]", simulation_.step_size());
  status.add("Scheme", simulation_.scheme());
  status.add("Steps", run_.steps);
  status.add("Newton iterations of the last step", run_.last_step.iterations);
  status.add("Step halvings", run_.counts.halvings);
  status.add("Recoveries", recoveries_text(run_.counts));
  status.add("Overruns (steps dropped)", run_.overruns);
  status.add("Steps whose states were not published", run_.missed);
  status.add("Steps cut short", run_.cut);
  const auto add = [&](const std::string& what, const DurationHistogram& histogram) {
    status.addf(what, "50 %%: %.3g, 99 %%: %.3g, 99.9 %%: %.3g, longest: %.3g", histogram.quantile(0.5),
                histogram.quantile(0.99), histogram.quantile(0.999), histogram.largest());
  };
  add("Wall time of a step [s]", run_.step_times);
  add("Lateness of its beginning [s]", run_.lateness);
}

}  // namespace flexarm::node
