#pragma once
/// Starts and stops trajectories and grips of joints, for the controllers.

#include <ros/time.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "limit_watch.h"
#include "stepping/grips.h"
#include "stepping/stepping_thread.h"
#include "stepping/trajectory_follower.h"

namespace flexarm::node {

/// Hands trajectories and grips to the stepping thread, and tells where joints should be at a given time. All times are
/// simulated and are not set back by resets [s].
class Motions {
 public:
  struct Context {
    std::function<double(const ros::Time&)>
        time_of;                           ///< converts a stamp to simulated time; call between two steps [s]
    std::function<std::string()> refusal;  ///< why commands are refused at present, or ""
    double stop_duration = 0;              ///< in which joints decelerate that are stopped [s]; 0: at once
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

  /// @param shown  the node's copy of the simulation, as of the last report
  Motions(const Simulation& shown, SteppingThread& stepping, Context context);
  Motions(const Motions&) = delete;
  Motions& operator=(const Motions&) = delete;

  const Simulation& shown() const { return shown_; }
  /// Why commands are refused at present, or "".
  std::string refusal() const { return context_.refusal(); }
  std::vector<std::string> names_of(const std::vector<std::size_t>& joints) const;
  /// Where the joint should be, if it follows a trajectory or has followed one; and when that trajectory ends.
  JointPoint at(std::size_t joint, double time) const { return followed_.at(joint, time); }
  double end(std::size_t joint) const { return followed_.end(joint); }
  /// To be called after each report. at() must not be called for earlier times any more.
  void release_arrived(double now);

  /// Makes the joints that the message names follow it, from its stamp on. A message without points stops all joints of
  /// the group that follow trajectories.
  /// @param group   names of the joints that the message may name; empty: all
  /// @param joints  gets the joints that follow or stop
  /// @returns why the message is refused, if it is
  Fault follow(const trajectory_msgs::JointTrajectory& message, const std::vector<std::string>& group,
               std::vector<std::size_t>& joints);
  /// Moves joints to positions, with at most the given effort [N or N m]; 0: only the servos' own limits.
  /// @returns an error, or ""
  std::string grip(const std::vector<Target>& targets, double max_effort);
  /// Stops those of the joints that follow trajectories.
  void stop(const std::vector<std::size_t>& joints);
  /// In lock step, makes one step. @returns false if too many steps wait already
  bool command_step() { return stepping_.command_step(); }
  /// Ends the trajectory or grip of a joint, if it has one.
  void release(std::size_t joint);
  void release_all();
  /// To be called after the simulation has got another scene.
  void adopt_scene();

 private:
  Fault follow_points(const trajectory_msgs::JointTrajectory& message, std::vector<std::size_t>& joints);
  /// Changes trajectories or grips between two steps.
  template <class Change>
  void change(const Change& change);

  const Simulation& shown_;
  SteppingThread& stepping_;
  Context context_;
  // Copies of the stepping thread's trajectories and grips, which can be read while steps go on:
  TrajectoryFollower followed_;
  Grips grips_;
  double reported_ = 0;  ///< simulated time of the last report [s]
  LimitWatch limit_watch_;
};

}  // namespace flexarm::node
