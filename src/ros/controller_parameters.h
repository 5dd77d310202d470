#pragma once
/// Reads the parameter ~controllers, which lists the node's controllers.

#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::node {

struct ControllerDescription {
  enum class Type { FollowJointTrajectory, GripperCommand };
  std::string name;                 ///< empty: the controller of all joints
  std::string action;               ///< name of the action, in the node's namespace
  std::vector<std::string> joints;  ///< empty: all
  Type type = Type::FollowJointTrajectory;
  // The rest is for grippers only.
  std::string command_joint;  ///< the joint to whose position a goal refers; the gripper's other driven joints go to
                              ///< that position, too
  bool is_parallel = false;   ///< true: a goal gives the sum of two joints' positions
  double max_effort = 0;      ///< limit of effort for goals that give none [N or N m]; 0: only the servos' own limits
  double goal_tolerance = 0.01;   ///< of position [m or rad]
  double stall_velocity = 0.001;  ///< a joint that is slower does not move [m/s or rad/s]
  double stall_timeout = 1;       ///< the goal is aborted after this simulated time without motion [s]
};

/// Reads ~controllers, which is a list like MoveIt's controller_list or a dictionary that contains such a list. Adds
/// the controller of all joints (follow_joint_trajectory) at the end, unless a listed controller has its action name.
/// @throws ParameterError that lists all errors, such as joints that do not exist or that cannot be driven
std::vector<ControllerDescription> read_controllers(const ros::NodeHandle& private_node, const Simulation& simulation);

/// The driven coordinate that a joint follows, directly or through mimics: joint = multiplier * driven + offset. For a
/// joint that mimics nothing, it is the joint's own coordinate.
struct DrivenBy {
  std::size_t coordinate;
  double multiplier = 1, offset = 0;
};
/// @throws std::invalid_argument if there is no such coordinate.
DrivenBy driven_by(const Simulation& simulation, const std::string& joint);

}  // namespace flexarm::node
