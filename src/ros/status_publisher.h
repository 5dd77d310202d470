#pragma once
/// Publishes the topic ~status: time, energies, momenta, figures of the solver and of the pace.

#include <flexarm/SimulatorStatus.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <string>

#include "flexarm/simulation/simulation.h"
#include "publication_schedule.h"
#include "real_time_factor.h"
#include "run_state.h"

namespace flexarm::node {

class StatusPublisher {
 public:
  StatusPublisher(ros::NodeHandle& private_node, const Simulation& simulation, const RunState& run, double rate,
                  const std::string& frame_prefix);
  StatusPublisher(const StatusPublisher&) = delete;
  StatusPublisher& operator=(const StatusPublisher&) = delete;

  /// Sets the rate [Hz] and restarts the schedule: the next message may have any stamp, even an earlier one.
  void set_rate(double rate) { schedule_ = PublicationSchedule(rate); }
  /// Sends the status if it is due, or in any case with `force`. If the stamp was already used, which happens if the
  /// simulation pauses right after a status, a forced status gets a stamp one nanosecond later.
  void publish(ros::Time stamp, bool force);

 private:
  SimulatorStatus make_message() const;

  const Simulation& simulation_;
  const RunState& run_;
  PublicationSchedule schedule_;
  std::string frame_prefix_;
  RealTimeFactor real_time_factor_{RealTimeFactor::Clock::now()};
  ros::Time stamp_;    ///< of the last message
  double factor_ = 0;  ///< real-time factor in that message
  ros::Publisher publisher_;
};

}  // namespace flexarm::node
