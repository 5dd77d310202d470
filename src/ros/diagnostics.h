#pragma once
/// /diagnostics: whether the simulation runs, and keeps up.

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "diagnostic_report.h"

namespace flexarm::node {

class Diagnostics {
 public:
  /// @throws ParameterError if ~diagnostic_period [s] (1) is not above 0.
  Diagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const Simulation& simulation, const RunState& run);

  /// Sends the diagnostics if the period is over; `force`: in any case.
  void publish(bool force);

 private:
  DiagnosticReport report_;
  ros::Publisher publisher_;
  ros::Duration period_;
  ros::Time last_time_;  ///< when they were sent last
};

}  // namespace flexarm::node
