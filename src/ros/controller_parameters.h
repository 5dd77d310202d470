#pragma once
/// Which controllers the node has: the parameter ~controllers.

#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::node {

struct ControllerDescription {
  enum class Type { FollowJointTrajectory, GripperCommand };
  std::string name;                 ///< empty: the controller of all joints
  std::string action;               ///< name of its action, in the node's namespace
  std::vector<std::string> joints;  ///< empty: all
  Type type = Type::FollowJointTrajectory;
  // Of grippers:
  std::string command_joint;      ///< whose position a goal gives, and others that are driven go to as well
  bool is_parallel = false;       ///< a goal gives the sum of two joints' positions
  double max_effort = 0;          ///< of goals that name none [N or N m]; 0: what servos give
  double goal_tolerance = 0.01;   ///< [m or rad]
  double stall_velocity = 0.001;  ///< of joints that do not move [m/s or rad/s]
  double stall_timeout = 1;       ///< for which they do not, while they are not at their goal, simulated [s]
};

/// Reads ~controllers, a list as MoveIt's controller_list, or a dictionary that has one. The last one is that of all
/// joints, unless another has its action.
/// @throws ParameterError with every error, joints that the simulation does not have or cannot move among them.
std::vector<ControllerDescription> read_controllers(const ros::NodeHandle& private_node, const Simulation& simulation);

/// Of the coordinates that a joint mimics, the one that is driven; and how the joint follows that.
struct DrivenBy {
  std::size_t coordinate;
  double multiplier = 1, offset = 0;
};
/// @throws std::invalid_argument if there is no such coordinate.
DrivenBy driven_by(const Simulation& simulation, const std::string& joint);

}  // namespace flexarm::node
