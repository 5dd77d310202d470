#pragma once
/// A recorded run, simulated again.

#include <algorithm>
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
  double largest = 1e-6;        ///< difference of positions up to which runs agree [rad or m]
  int timing = 1;               ///< steps by which a command may act beside what the bag's times say
};

struct JointDeviation {
  std::string joint;                            ///< coordinate
  double position = 0, velocity = 0;            ///< largest difference [rad or m; over s]
  double position_time = 0, velocity_time = 0;  ///< where it is, simulated [s]
  /// How far positions of other_times are from those of this replay, in all; and by how much the bag's are farther off
  /// than those until then, at most [rad or m].
  double by_times = 0, unexplained = 0, unexplained_time = 0;
};

/// Replays whose commands act in other steps, as they may have in the run.
struct OtherTimes {
  int replays = 0;             ///< 0: there was no need, or the bag leaves no doubt
  int earlier = 0, later = 0;  ///< by at most so many steps
};

struct ReplayReport {
  std::size_t states = 0;    ///< that were compared
  std::size_t commands = 0;  ///< that were given
  std::size_t refused = 0;   ///< that were not: the node has refused them, too
  std::string first_refusal;
  long steps = 0;
  std::vector<JointDeviation> joints;
  OtherTimes other_times;

  /// Whether no position is off by more than `largest` and what the times of commands explain.
  bool agrees(double largest) const {
    return std::all_of(joints.begin(), joints.end(),
                       [&](const JointDeviation& joint) { return joint.unexplained <= largest; });
  }
};

/// Gives the commands of a bag to a simulation that is in the state of the first joint_states of the bag, and compares
/// those that follow. The bag has the times at which its recorder got messages; the node got commands at others, and
/// acts on them when its next step begins. So where positions differ by more than `largest`, the commands are given
/// again and again, each of them up to `timing` steps earlier or later, and earlier by as many more as the steps were
/// late then, by the times at which their states came: all early, all late, by turns, at random. How far those runs are
/// from the first one is what times explain. In lock step there is nothing to explain. Topics: joint_states;
/// joint_force_command, joint_command, joint_set_points, joint_trajectory, JOINT/command, JOINT/set_point.
/// @throws std::invalid_argument naming the file if it cannot be read, has no states or they cannot be of this
/// simulation;
///   std::runtime_error if a step fails
ReplayReport replay(Simulation simulation, const ReplayOptions& options);

}  // namespace flexarm::recording
