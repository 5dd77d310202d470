#pragma once
/// joint_states, /tf and /tf_static.

#include <geometry_msgs/TransformStamped.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <cstddef>
#include <string>
#include <unordered_set>
#include <vector>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/simulation.h"
#include "publication_schedule.h"
#include "run_state.h"

namespace flexarm::node {

/// Publishes every released coordinate, and every link frame of the deformed configuration as a child of its parent
/// link; the end of a flexible link is `LINK/tip`. Fixed joints between rigid links go to /tf_static, once.
/// All names of frames begin with a prefix, which may be empty.
/// Who comes while the simulation is paused is told where the arm stands (see advertise.h).
class StatePublisher {
 public:
  StatePublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate,
                 const std::string& frame_prefix);
  StatePublisher(const StatePublisher&) = delete;
  StatePublisher& operator=(const StatePublisher&) = delete;

  /// Sends the state if it is due (see PublicationSchedule).
  void publish(const ros::Time& stamp, bool force);
  /// The names of all frames that are published, static ones too.
  const std::unordered_set<std::string>& frames() const { return frame_names_; }

 private:
  void collect_frames(const scene::SceneDescription& scene, const std::string& prefix);
  void publish_joint_states(const ros::Time& stamp);
  void publish_transforms(const ros::Time& stamp);

  /// A link frame in its parent's, by index into the simulation's links.
  struct Frame {
    std::size_t parent, child;
  };

  const Simulation& simulation_;
  PublicationSchedule schedule_;
  std::vector<Frame> frames_;  ///< of links that move in their parents
  std::vector<std::size_t> flexible_links_;
  std::unordered_set<std::string> frame_names_;
  sensor_msgs::JointState joint_states_;  ///< kept, so that names are copied once
  tf2_msgs::TFMessage transforms_;        ///< frames_, then the tips of flexible_links_
  ros::Publisher joint_state_publisher_, transform_publisher_, static_transform_publisher_;
};

}  // namespace flexarm::node
