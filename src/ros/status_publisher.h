#pragma once
/// ~status: time, energies, momenta, how the solver and the pacing are doing.

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

  /// Begins anew at a rate [Hz], with any stamp.
  void set_rate(double rate) { schedule_ = PublicationSchedule(rate); }
  /// Sends the status if it is due. `force` sends it in any case: where the stamp is not new, which happens when the
  /// simulation pauses right after a status, it is moved on by a nanosecond.
  void publish(ros::Time stamp, bool force);

 private:
  SimulatorStatus make_message() const;

  const Simulation& simulation_;
  const RunState& run_;
  PublicationSchedule schedule_;
  std::string frame_prefix_;
  RealTimeFactor real_time_factor_{RealTimeFactor::Clock::now()};
  ros::Time stamp_;    ///< of what was published last
  double factor_ = 0;  ///< simulated per wall time, as it was then
  ros::Publisher publisher_;
};

}  // namespace flexarm::node
