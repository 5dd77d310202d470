#pragma once
/// Makes messages of the joints and frames of a simulation.

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

/// The messages contain each free coordinate and each link frame of the deformed configuration, as a child of the
/// parent link's frame. The end of a flexible link is the frame `LINK/tip`. Fixed joints between rigid links are in a
/// message of their own, since they never change.
class StateMessages {
 public:
  /// @param simulation    must outlive this object
  /// @param frame_prefix  put before all names of frames; may be empty
  StateMessages(const Simulation& simulation, const std::string& frame_prefix);

  void update_joint_states(const ros::Time& stamp);
  void update_transforms(const ros::Time& stamp);

  // ---- as of the last update
  const sensor_msgs::JointState& joint_states() const { return joint_states_; }
  const tf2_msgs::TFMessage& transforms() const { return transforms_; }
  tf2_msgs::TFMessage static_transforms(const ros::Time& stamp) const;

  /// The names of all frames, including static ones.
  const std::unordered_set<std::string>& frames() const { return frame_names_; }

 private:
  /// A link's frame in its parent's frame; both are indices of the simulation's links.
  struct Frame {
    std::size_t parent, child;
  };

  const Simulation& simulation_;
  std::vector<Frame> frames_;  ///< of links that move relative to their parents
  std::vector<std::size_t> flexible_links_;
  std::unordered_set<std::string> frame_names_;
  sensor_msgs::JointState joint_states_;  ///< kept between updates, so that names are copied only once
  tf2_msgs::TFMessage transforms_;        ///< frames_, then the tips of flexible_links_
  tf2_msgs::TFMessage static_transforms_;
};

}  // namespace flexarm::messages
