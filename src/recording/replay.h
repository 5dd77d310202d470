#pragma once
/// A recorded run, simulated again.

#include <cstddef>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::recording {

struct ReplayOptions {
  std::string bag;
  std::string ns;               ///< of the arm's topics, "/left" say; empty: none
  bool lock_step = false;       ///< each command has made one step; else steps were due by the stamps of states
  double real_time_factor = 1;  ///< of the run, where it was not the clock itself
  double command_timeout = 0;   ///< as the node's parameter [s]
  double stop_duration = 0;     ///< the same [s]
};

struct JointDeviation {
  std::string joint;                            ///< coordinate
  double position = 0, velocity = 0;            ///< largest difference [rad or m; over s]
  double position_time = 0, velocity_time = 0;  ///< where it is, simulated [s]
};

struct ReplayReport {
  std::size_t states = 0;    ///< that were compared
  std::size_t commands = 0;  ///< that were given
  std::size_t refused = 0;   ///< that were not: the node has refused them, too
  std::string first_refusal;
  long steps = 0;
  std::vector<JointDeviation> joints;
};

/// Gives the commands of a bag to a simulation that is in the state of the first joint_states of the bag, and compares
/// those that follow. Topics: joint_states; joint_force_command, joint_command, joint_set_points, joint_trajectory,
/// JOINT/command, JOINT/set_point.
/// @throws std::invalid_argument naming the file if it cannot be read, has no states or they cannot be of this
/// simulation;
///   std::runtime_error if a step fails
ReplayReport replay(Simulation simulation, const ReplayOptions& options);

}  // namespace flexarm::recording
