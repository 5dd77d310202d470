#pragma once
/// What /diagnostics says of the simulation.

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <cstdint>

namespace flexarm {
class Simulation;
}

namespace flexarm::node {

struct RunState;

/// Whether the simulation runs and keeps up, and how its steps go. Both must outlive the report.
class DiagnosticReport {
 public:
  DiagnosticReport(const Simulation& simulation, const RunState& run) : simulation_(simulation), run_(run) {}

  /// Sets level and message, by what happened since the last call, and adds values.
  void write(diagnostic_msgs::DiagnosticStatus& status);

 private:
  const Simulation& simulation_;
  const RunState& run_;
  std::uint64_t reported_overruns_ = 0;
};

}  // namespace flexarm::node
