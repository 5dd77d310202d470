#pragma once
/// ~status: time, energies, momenta, how the solver and the pacing are doing.

#include <flexarm/SimulatorStatus.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <chrono>

#include "flexarm/simulation/simulation.h"
#include "publication_schedule.h"
#include "run_state.h"

namespace flexarm::node {

class StatusPublisher {
 public:
  StatusPublisher(ros::NodeHandle& private_node, const Simulation& simulation, const RunState& run, double rate);
  StatusPublisher(const StatusPublisher&) = delete;
  StatusPublisher& operator=(const StatusPublisher&) = delete;

  /// Sends the status if it is due. `force` sends it in any case: where the stamp is not new, which happens when the
  /// simulation pauses right after a status, it is moved on by a nanosecond.
  void publish(ros::Time stamp, bool force);

 private:
  SimulatorStatus make_message(const ros::Time& stamp);
  double measure_real_time_factor();

  const Simulation& simulation_;
  const RunState& run_;
  PublicationSchedule schedule_;
  std::chrono::steady_clock::time_point last_wall_time_ = std::chrono::steady_clock::now();
  double last_simulated_time_ = 0;
  SimulatorStatus last_message_;
  ros::Publisher publisher_;
};

}  // namespace flexarm::node
