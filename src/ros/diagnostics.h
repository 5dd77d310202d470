#pragma once
/// Publishes /diagnostics: whether the simulation runs and keeps pace.

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "diagnostic_report.h"

namespace flexarm::node {

class Diagnostics {
 public:
  /// @throws ParameterError if ~diagnostic_period [s] (default 1) is not above 0.
  Diagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const Simulation& simulation, const RunState& run);

  /// Publishes if ~diagnostic_period has passed since the last message, or if `force` is true.
  void publish(bool force);

 private:
  DiagnosticReport report_;
  ros::Publisher publisher_;
  ros::Duration period_;
  ros::Time last_time_;  ///< when the last message was sent
};

}  // namespace flexarm::node
