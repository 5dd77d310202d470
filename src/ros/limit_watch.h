#pragma once
/// Warns of commands that send joints beyond their limits.

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

#include "flexarm/simulation/simulation.h"
#include "stepping/trajectory_follower.h"

namespace flexarm::node {

/// Such commands are obeyed, and the joint's stop holds it. Of commands to a joint that come shortly after each other
/// only the first one causes a warning. Short times are by the wall clock: ROS time stands still while a simulation
/// that is the clock is paused.
class LimitWatch {
 public:
  /// @param shown  what is stepped, as reports have it
  explicit LimitWatch(const Simulation& shown) : shown_(shown) {}

  /// Looks at where a joint is to go [m or rad].
  void look(std::size_t joint, double position) { look(joint, position, position); }
  /// Looks at all points of a trajectory, of each joint.
  void look(const JointTrajectory& trajectory);

 private:
  using Clock = std::chrono::steady_clock;
  /// The same of positions from `least` to `most`.
  void look(std::size_t joint, double least, double most);

  const Simulation& shown_;
  std::map<std::string, Clock::time_point> last_;  ///< when a joint was last sent beyond its limits
};

}  // namespace flexarm::node
