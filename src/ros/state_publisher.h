#pragma once
/// Publishes joint_states, /tf and /tf_static.

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <memory>
#include <optional>
#include <string>
#include <unordered_set>

#include "flexarm/simulation/simulation.h"
#include "messages/state_messages.h"
#include "publication_schedule.h"
#include "run_state.h"

namespace flexarm::node {

/// Frames that never change go to /tf_static, once. A subscriber that connects while the simulation is paused gets the
/// present state at once (see advertise.h).
class StatePublisher {
 public:
  /// @param frame_prefix  put before all names of frames; may be empty
  StatePublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate,
                 const std::string& frame_prefix);
  StatePublisher(const StatePublisher&) = delete;
  StatePublisher& operator=(const StatePublisher&) = delete;

  /// To be called after the simulation has got another scene.
  void adopt_scene();
  /// Sets the rate [Hz] and restarts the schedule: the next message may have any stamp, even an earlier one.
  void set_rate(double rate) { schedule_ = PublicationSchedule(rate); }
  /// Sends the state if it is due (see PublicationSchedule).
  void publish(const ros::Time& stamp, bool force);
  /// The names of all frames that are published, including static ones.
  const std::unordered_set<std::string>& frames() const { return messages_->frames(); }

 private:
  /// Joint states and frames of the present state, with the last stamp.
  const sensor_msgs::JointState& joint_states();
  const tf2_msgs::TFMessage& transforms();
  void send_static_transforms();

  const Simulation& simulation_;
  std::string frame_prefix_;
  PublicationSchedule schedule_;
  std::optional<messages::StateMessages> messages_;
  ros::Time stamp_;
  ros::Publisher joint_state_publisher_;
  /// A broadcaster neither knows whether somebody listens, nor serves those who come while time stands still, and its
  /// queue is short. Publishers of one node share a topic's queue and subscribers. So this one, which is advertised
  /// first, sees to all that, and the broadcaster sends.
  ros::Publisher transform_publisher_;
  tf2_ros::TransformBroadcaster transform_broadcaster_;
  std::unique_ptr<tf2_ros::StaticTransformBroadcaster> static_transform_broadcaster_;
};

}  // namespace flexarm::node
