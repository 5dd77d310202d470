#pragma once
/// The content of the node's message on /diagnostics.

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <cstdint>

namespace flexarm {
class Simulation;
}

namespace flexarm::node {

struct RunState;

/// Reports whether the simulation runs and keeps pace, and how the solver does. Both arguments must outlive the report.
class DiagnosticReport {
 public:
  DiagnosticReport(const Simulation& simulation, const RunState& run) : simulation_(simulation), run_(run) {}

  /// Sets level and message by what happened since the last call, and appends values.
  void write(diagnostic_msgs::DiagnosticStatus& status);

 private:
  const Simulation& simulation_;
  const RunState& run_;
  std::uint64_t reported_overruns_ = 0;
};

}  // namespace flexarm::node
