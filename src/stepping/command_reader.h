#pragma once
/// Converts ROS messages into commands for joint coordinates. Independent of the node, so that replays can use it too.

#include <flexarm/JointForceCommand.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <cstddef>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "timed_commands.h"
#include "trajectory_follower.h"

namespace flexarm::node {

/// Reads messages. If any part of a message is wrong, the whole message is refused. All functions return the reason why
/// a message is refused, or an empty string.
class CommandReader {
 public:
  /// @param shown    the simulation whose coordinates are commanded, with the present modes of its servos
  /// @param timeout  lifetime of commands without a duration [s]; 0: unlimited
  CommandReader(const Simulation& shown, double timeout) : shown_(shown), timeout_(timeout) {}

  std::string read_force_command(const JointForceCommand& message, std::vector<Command>& commands) const;
  /// For joint_command: reads efforts; if the message has none, set points.
  std::string read_joint_command(const sensor_msgs::JointState& message, std::vector<Command>& commands) const;
  std::string read_set_points(const sensor_msgs::JointState& message, std::vector<Command>& commands) const;
  std::string read_one(Commanded quantity, const std::string& name, double value, std::vector<Command>& commands) const;

 private:
  /// @param duration  lifetime [s]; 0: the timeout applies
  std::string read(Commanded quantity, const std::vector<std::string>& names, const std::vector<double>& values,
                   double duration, std::vector<Command>& commands) const;
  std::string find_fault(Commanded quantity, std::size_t coordinate) const;

  const Simulation& shown_;
  double timeout_;
};

/// Finds the coordinates of a trajectory by name. @returns why they cannot follow a trajectory, or an empty string
std::string read_trajectory_joints(const Simulation& shown, const std::vector<std::string>& names,
                                   std::vector<std::size_t>& joints);

/// Converts the points of a message. Leaves the start time at zero.
JointTrajectory trajectory_of(const trajectory_msgs::JointTrajectory& message, std::vector<std::size_t> joints);

}  // namespace flexarm::node
