#pragma once
/// Publishes the topic beam_states: poses, strains and stress resultants along each flexible link.

#include <flexarm/BeamStateArray.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "publication_schedule.h"
#include "run_state.h"

namespace flexarm::node {

/// Computes and publishes messages only while the topic has subscribers.
class BeamStatePublisher {
 public:
  BeamStatePublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate,
                     const std::string& frame_prefix);
  BeamStatePublisher(const BeamStatePublisher&) = delete;
  BeamStatePublisher& operator=(const BeamStatePublisher&) = delete;

  /// Sets the rate [Hz] and restarts the schedule: the next message may have any stamp, even an earlier one.
  void set_rate(double rate) { schedule_ = PublicationSchedule(rate); }
  void publish(const ros::Time& stamp, bool force);

 private:
  BeamStateArray make_message(const ros::Time& stamp);

  const Simulation& simulation_;
  PublicationSchedule schedule_;
  std::string frame_prefix_;
  ros::Time stamp_;                ///< of the current state
  std::vector<BeamPoint> points_;  ///< scratch
  ros::Publisher publisher_;
};

}  // namespace flexarm::node
