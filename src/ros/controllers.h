#pragma once
/// All controllers of the node, and trajectories from a topic.

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "controller_parameters.h"
#include "joint_controller.h"
#include "motions.h"

namespace flexarm::node {

/// An action for each of ~controllers, and follow_joint_trajectory for all joints. What comes on joint_trajectory is
/// for all joints, too. Where a goal takes a joint from another controller's, that one ends.
class Controllers {
 public:
  /// @param warn  of what came by the topic and is refused
  /// @throws ParameterError as read_controllers().
  Controllers(ros::NodeHandle& node, ros::NodeHandle& private_node, const Simulation& shown, SteppingThread& stepping,
              Motions::Context context, std::function<void(const std::string&)> warn);
  Controllers(const Controllers&) = delete;
  Controllers& operator=(const Controllers&) = delete;

  /// Judges all goals by what is shown, of the time `now` [s].
  void judge(double now);
  /// Somebody else commands the coordinate: what it follows is over, and so is the goal that it belongs to.
  void release(std::size_t coordinate, const std::string& reason);
  /// What is stepped is of another scene now.
  void adopt_scene() { motions_.adopt_scene(); }
  /// Nothing is followed any more.
  void release_all(const std::string& reason);

 private:
  void add(ros::NodeHandle& node, const ControllerDescription& description);
  /// Joints now belong to `taker`, another controller or the topic.
  void take(std::size_t taker, const std::vector<std::size_t>& joints);
  void receive(const trajectory_msgs::JointTrajectory& message);

  Motions motions_;
  std::function<void(const std::string&)> warn_;
  std::vector<std::unique_ptr<JointController>> controllers_;
  ros::Subscriber subscriber_;
};

}  // namespace flexarm::node
