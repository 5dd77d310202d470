#pragma once
/// Trajectories of joints from a topic and an action.

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <functional>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "stepping/stepping_thread.h"
#include "stepping/trajectory_follower.h"
#include "trajectory_action.h"
#include "trajectory_goal.h"

namespace flexarm::node {

/// Lets servos of mode position follow what joint_trajectory and the action follow_joint_trajectory ask for, as
/// joint_trajectory_controller does. Times are simulated ones that no reset sets back [s].
class Trajectories {
 public:
  struct Context {
    std::function<double(const ros::Time&)> time_of;  ///< of a stamp, between two steps [s]
    std::function<std::string()> refusal;             ///< why nothing may be commanded now, or nothing
    std::function<void(const std::string&)> warn;     ///< of what came by the topic and is refused
  };
  /// @param shown          what is stepped, as reports have it
  /// @param stop_duration  in which joints that are to stop decelerate [s]; 0: they stop at once
  Trajectories(ros::NodeHandle& node, const Simulation& shown, SteppingThread& stepping, Context context,
               double stop_duration);
  Trajectories(const Trajectories&) = delete;
  Trajectories& operator=(const Trajectories&) = delete;

  /// Judges the goal by what is shown, of the time `now` [s].
  void judge(double now);
  /// Somebody else commands the coordinate: its trajectory is over, and so is the goal, if that is one of its.
  void release(std::size_t coordinate, const std::string& reason);
  /// What is stepped is of another scene now.
  void adopt_scene() { followed_ = stepping_.trajectories(); }
  /// Nothing is followed any more.
  void release_all(const std::string& reason);

 private:
  using Result = FollowJointTrajectoryResult;
  /// Why a message is refused.
  struct Fault {
    int code = Result::SUCCESSFUL;
    std::string text;
    bool is_none() const { return text.empty(); }
  };

  void receive(const trajectory_msgs::JointTrajectory& message);
  /// @returns without a text: it is followed
  Result follow_goal(const FollowJointTrajectoryGoal& message);
  /// Follows it, or says why not. Its joints, or those that stop, are in `joints`.
  Fault follow(const trajectory_msgs::JointTrajectory& message, std::vector<std::size_t>& joints);
  std::vector<std::string> names_of(const std::vector<std::size_t>& joints) const;
  std::vector<std::size_t> moving_joints() const;
  void stop(const std::vector<std::size_t>& joints);
  /// Changes what is followed, between two steps.
  template <class Change>
  void change(const Change& change);
  void publish_feedback(double now, const std::vector<JointPoint>& desired, const std::vector<JointPoint>& actual);

  const Simulation& shown_;
  SteppingThread& stepping_;
  Context context_;
  double stop_duration_;
  TrajectoryFollower followed_;  ///< a copy of what is followed, to be looked at while steps go on
  ros::Subscriber subscriber_;
  TrajectoryAction action_;
  TrajectoryGoal goal_;                       ///< under way
  double next_feedback_ = 0;                  ///< [s]
  std::vector<JointPoint> desired_, actual_;  ///< scratch: of the goal's joints
};

}  // namespace flexarm::node
