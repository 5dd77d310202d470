#pragma once
/// All controllers of the node, and the topic joint_trajectory.

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

/// Offers an action for each entry of ~controllers, and follow_joint_trajectory for all joints. Also subscribes to
/// joint_trajectory, which takes any joints. If a new goal uses a joint of another controller's goal, the old goal
/// ends.
class Controllers {
 public:
  /// @param warn  called with the reason if a message on the topic is refused
  /// @throws ParameterError as read_controllers() does.
  Controllers(ros::NodeHandle& node, ros::NodeHandle& private_node, const Simulation& shown, SteppingThread& stepping,
              Motions::Context context, std::function<void(const std::string&)> warn);
  Controllers(const Controllers&) = delete;
  Controllers& operator=(const Controllers&) = delete;

  /// Checks all goals against the node's copy of the simulation, at the simulated time `now` [s].
  void judge(double now);
  /// To be called if the coordinate gets a command from elsewhere: it stops following, and its goal is aborted.
  void release(std::size_t coordinate, const std::string& reason);
  /// To be called before links come or go. Goals with joints that will be gone are aborted; the others go on.
  void renumber(const Renumbering& places);
  /// To be called after the simulation has got another scene.
  void adopt_scene() { motions_.adopt_scene(); }
  /// Ends all trajectories, grips and goals.
  void release_all(const std::string& reason);

 private:
  void add(ros::NodeHandle& node, const ControllerDescription& description);
  /// Gives joints to `taker`, the index of a controller (controllers_.size(): the topic); ends the goals of others.
  void take(std::size_t taker, const std::vector<std::size_t>& joints);
  void receive(const trajectory_msgs::JointTrajectory& message);

  Motions motions_;
  std::function<void(const std::string&)> warn_;
  std::vector<std::unique_ptr<JointController>> controllers_;
  ros::Subscriber subscriber_;
};

}  // namespace flexarm::node
