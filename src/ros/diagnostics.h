#pragma once
/// /diagnostics: whether the simulation runs, and keeps up.

#include <diagnostic_updater/diagnostic_updater.h>

#include <cstdint>

#include "run_state.h"

namespace flexarm::node {

class Diagnostics {
 public:
  Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node, const Simulation& simulation,
              const RunState& run);

  /// Sends the diagnostics if they are due (parameter ~diagnostic_period, 1 s); `force`: in any case.
  void publish(bool force);

 private:
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  const Simulation& simulation_;
  const RunState& run_;
  std::uint64_t reported_overruns_ = 0;
  diagnostic_updater::Updater updater_;
};

}  // namespace flexarm::node
