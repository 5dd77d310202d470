#pragma once
/// /diagnostics: whether the simulation runs, and keeps up.

#include <ros/node_handle.h>

#include <memory>

#include "diagnostic_report.h"

namespace diagnostic_updater {
class Updater;
}

namespace flexarm::node {

class Diagnostics {
 public:
  Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node, const Simulation& simulation,
              const RunState& run);
  ~Diagnostics();
  Diagnostics(const Diagnostics&) = delete;
  Diagnostics& operator=(const Diagnostics&) = delete;

  /// Sends the diagnostics if they are due (parameter ~diagnostic_period, 1 s); `force`: in any case.
  void publish(bool force);

 private:
  DiagnosticReport report_;
  std::unique_ptr<diagnostic_updater::Updater> updater_;  // its header is a large one
  ros::Time last_time_;                                   ///< when it was asked for last
};

}  // namespace flexarm::node
