#pragma once
/// joint_states, /tf and /tf_static.

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <optional>
#include <string>
#include <unordered_set>

#include "flexarm/simulation/simulation.h"
#include "messages/state_messages.h"
#include "publication_schedule.h"
#include "run_state.h"

namespace flexarm::node {

/// Publishes joints and frames; those that never change go to /tf_static, once. Who comes while the simulation is
/// paused is told where the arm stands (see advertise.h).
class StatePublisher {
 public:
  /// All names of frames begin with `frame_prefix`, which may be empty.
  StatePublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate,
                 const std::string& frame_prefix);
  StatePublisher(const StatePublisher&) = delete;
  StatePublisher& operator=(const StatePublisher&) = delete;

  /// The simulation is of another scene now.
  void adopt_scene();
  /// Begins anew at a rate [Hz], with any stamp.
  void set_rate(double rate) { schedule_ = PublicationSchedule(rate); }
  /// Sends the state if it is due (see PublicationSchedule).
  void publish(const ros::Time& stamp, bool force);
  /// The names of all frames that are published, static ones too.
  const std::unordered_set<std::string>& frames() const { return messages_->frames(); }

 private:
  /// As they are now, with the last stamp.
  const sensor_msgs::JointState& joint_states();
  const tf2_msgs::TFMessage& transforms();

  const Simulation& simulation_;
  std::string frame_prefix_;
  PublicationSchedule schedule_;
  std::optional<messages::StateMessages> messages_;
  ros::Time stamp_;
  ros::Publisher joint_state_publisher_, transform_publisher_, static_transform_publisher_;
};

}  // namespace flexarm::node
