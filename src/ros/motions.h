#pragma once
/// What controllers let joints do.

#include <ros/time.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "stepping/grips.h"
#include "stepping/stepping_thread.h"
#include "stepping/trajectory_follower.h"

namespace flexarm::node {

/// Hands trajectories and grips to the thread that steps, and knows what joints are to do at a time. Times are
/// simulated ones that no reset sets back [s].
class Motions {
 public:
  struct Context {
    std::function<double(const ros::Time&)> time_of;  ///< of a stamp, between two steps [s]
    std::function<std::string()> refusal;             ///< see refusal()
    double stop_duration = 0;                         ///< in which joints decelerate that are to stop [s]; 0: at once
  };
  /// Why a message is refused, with an error code of control::FollowJointTrajectoryResult.
  struct Fault {
    int code = 0;
    std::string text;
    bool is_none() const { return text.empty(); }
  };
  struct Target {
    std::size_t joint;
    double position;  ///< [m or rad]
  };

  /// @param shown  what is stepped, as reports have it
  Motions(const Simulation& shown, SteppingThread& stepping, Context context);
  Motions(const Motions&) = delete;
  Motions& operator=(const Motions&) = delete;

  const Simulation& shown() const { return shown_; }
  /// Why nothing may be commanded now, or nothing.
  std::string refusal() const { return context_.refusal(); }
  std::vector<std::string> names_of(const std::vector<std::size_t>& joints) const;
  /// Where the joint is to be, if it follows a trajectory or has followed one; when that ends.
  JointPoint at(std::size_t joint, double time) const { return followed_.at(joint, time); }
  double end(std::size_t joint) const { return followed_.end(joint); }
  void release_arrived(double now) { followed_.release_arrived(now); }

  /// Lets `joints`, which the message names, follow it from its stamp on; without points, those of the group stop that
  /// are on trajectories. Or says why not.
  /// @param group  of which the message names joints; empty: all
  Fault follow(const trajectory_msgs::JointTrajectory& message, const std::vector<std::string>& group,
               std::vector<std::size_t>& joints);
  /// Lets joints go to positions with at most that effort [N or N m]; 0: with what their servos give.
  /// @returns why not, or nothing
  std::string grip(const std::vector<Target>& targets, double max_effort);
  /// Lets those of the joints stop that are on trajectories.
  void stop(const std::vector<std::size_t>& joints);
  /// In lock step, makes one step. @returns false if too many wait already
  bool command_step() { return stepping_.command_step(); }
  /// Leaves a joint to others. @returns false if it was left to them anyway
  bool release(std::size_t joint);
  void release_all();
  /// What is stepped is of another scene now.
  void adopt_scene();

 private:
  Fault follow_points(const trajectory_msgs::JointTrajectory& message, std::vector<std::size_t>& joints);
  /// Changes what is followed, between two steps.
  template <class Change>
  void change(const Change& change);

  const Simulation& shown_;
  SteppingThread& stepping_;
  Context context_;
  // Copies of what the thread has, to be looked at while steps go on:
  TrajectoryFollower followed_;
  Grips grips_;
};

}  // namespace flexarm::node
