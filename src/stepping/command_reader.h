#pragma once
/// What messages command. Knows no node: replays read recorded ones.

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

/// Reads each message whole. All functions return why it is refused, or nothing.
class CommandReader {
 public:
  /// @param shown    whose coordinates are commanded, with the modes that their servos have now
  /// @param timeout  a command expires after it, unless it names a duration [s]; 0: never
  CommandReader(const Simulation& shown, double timeout) : shown_(shown), timeout_(timeout) {}

  std::string read_force_command(const JointForceCommand& message, std::vector<Command>& commands) const;
  /// Of joint_command: efforts, or else set points.
  std::string read_joint_command(const sensor_msgs::JointState& message, std::vector<Command>& commands) const;
  std::string read_set_points(const sensor_msgs::JointState& message, std::vector<Command>& commands) const;
  std::string read_one(Commanded quantity, const std::string& name, double value, std::vector<Command>& commands) const;

 private:
  /// @param duration  [s]; 0: the timeout counts
  std::string read(Commanded quantity, const std::vector<std::string>& names, const std::vector<double>& values,
                   double duration, std::vector<Command>& commands) const;
  std::string find_fault(Commanded quantity, std::size_t coordinate) const;

  const Simulation& shown_;
  double timeout_;
};

/// The coordinates that a trajectory names. @returns why they cannot follow one, or nothing
std::string read_trajectory_joints(const Simulation& shown, const std::vector<std::string>& names,
                                   std::vector<std::size_t>& joints);

/// The points of a message; its start is left open.
JointTrajectory trajectory_of(const trajectory_msgs::JointTrajectory& message, std::vector<std::size_t> joints);

}  // namespace flexarm::node
