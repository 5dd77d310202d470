#pragma once
/// Replays a run that was recorded in a ROS bag, and compares the results.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::recording {

/// What a bag says of the coordinates at one time; NaN: not recorded.
struct RecordedJoints {
  std::vector<double> positions, efforts;
};

/// What to replay, and how to compare.
struct ReplayOptions {
  std::string bag;
  std::string ns;               ///< namespace of the arm's topics, such as "/left"; empty: none
  bool lock_step = false;       ///< each command caused one step; false: the stamps of states tell when steps were due
  double real_time_factor = 1;  ///< of the recorded run, unless the node was the clock
  double command_timeout = 0;   ///< the node's parameter of this name [s]
  double stop_duration = 0;     ///< the node's parameter of this name [s]
  double largest = 1e-6;        ///< tolerance for differences of positions [rad or m]
  int timing = 1;               ///< number of steps by which a command may have acted earlier or later than recorded
  /// Called for each state that is compared, with the replayed simulation at that time.
  std::function<void(const Simulation& replayed, const RecordedJoints& recorded)> on_state = {};
};

/// Deviation of a coordinate's recorded motion from the replayed one.
struct JointDeviation {
  std::string joint;                            ///< name of the coordinate
  double position = 0, velocity = 0;            ///< largest differences [rad or m; per s]
  double position_time = 0, velocity_time = 0;  ///< simulated times of these [s]
  /// Largest deviation of the replays with other_times from this one [rad or m]. Then the largest amount by which the
  /// recorded positions deviate more than those replays had until that time [rad or m], and its simulated time [s].
  double by_times = 0, unexplained = 0, unexplained_time = 0;
};

/// Additional replays in which commands act in other steps, as they may have in the recorded run.
struct OtherTimes {
  int replays = 0;             ///< 0: none was needed, or the bag is unambiguous
  int earlier = 0, later = 0;  ///< largest number of steps by which commands act earlier or later
};

/// The outcome of a replay.
struct ReplayReport {
  std::size_t states = 0;    ///< number of compared states
  std::size_t commands = 0;  ///< number of accepted commands
  std::size_t refused = 0;   ///< number of refused commands, which the node refused as well
  std::string first_refusal;
  long steps = 0;
  std::vector<JointDeviation> joints;
  OtherTimes other_times;

  /// Whether the times of commands explain all deviations of positions, to within `largest`.
  bool agrees(double largest) const {
    return std::all_of(joints.begin(), joints.end(),
                       [&](const JointDeviation& joint) { return joint.unexplained <= largest; });
  }
};

/// Gives the commands of a bag to a simulation in the state of the bag's first joint_states, and compares the following
/// states. The bag contains the times at which its recorder received messages. The node received commands at other
/// times, and applied them when its next step began. So if positions differ by more than `largest`, the replay is
/// repeated with commands that act up to `timing` steps earlier or later. If the run was late, which the arrival times
/// of states show, commands may act still earlier by this lateness. The variants are: all commands early, all late,
/// alternating, random. Their deviation from the first replay is the part that times explain. Lock step is unambiguous
/// and needs no variants. Topics: joint_states; joint_force_command, joint_command, joint_set_points, joint_trajectory,
/// JOINT/command, JOINT/set_point.
/// @throws std::invalid_argument naming the file if it cannot be read, has no states, or its states do not belong to
/// this simulation; std::runtime_error if a step fails
ReplayReport replay(Simulation simulation, const ReplayOptions& options);

}  // namespace flexarm::recording
