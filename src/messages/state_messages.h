#pragma once
/// Joints and frames of a simulation.

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <cstddef>
#include <string>
#include <unordered_set>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::messages {

/// Every released coordinate, and every link frame of the deformed configuration as a child of its parent link; the end
/// of a flexible link is `LINK/tip`. Fixed joints between rigid links stand apart: they never change.
class StateMessages {
 public:
  /// All names of frames begin with `frame_prefix`, which may be empty. The simulation must outlive this.
  StateMessages(const Simulation& simulation, const std::string& frame_prefix);

  void update_joint_states(const ros::Time& stamp);
  void update_transforms(const ros::Time& stamp);

  // ---- as they were updated last
  const sensor_msgs::JointState& joint_states() const { return joint_states_; }
  const tf2_msgs::TFMessage& transforms() const { return transforms_; }
  tf2_msgs::TFMessage static_transforms(const ros::Time& stamp) const;

  /// The names of all frames, static ones too.
  const std::unordered_set<std::string>& frames() const { return frame_names_; }

 private:
  /// A link frame in its parent's, by index into the simulation's links.
  struct Frame {
    std::size_t parent, child;
  };

  const Simulation& simulation_;
  std::vector<Frame> frames_;  ///< of links that move in their parents
  std::vector<std::size_t> flexible_links_;
  std::unordered_set<std::string> frame_names_;
  sensor_msgs::JointState joint_states_;  ///< kept, so that names are copied once
  tf2_msgs::TFMessage transforms_;        ///< frames_, then the tips of flexible_links_
  tf2_msgs::TFMessage static_transforms_;
};

}  // namespace flexarm::messages
