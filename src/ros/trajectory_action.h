#pragma once
/// The action follow_joint_trajectory: one goal at a time, and what its client is told.

#include <flexarm/FollowJointTrajectoryFeedback.h>
#include <flexarm/FollowJointTrajectoryGoal.h>
#include <flexarm/FollowJointTrajectoryResult.h>
#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <string>

namespace flexarm::node {

class TrajectoryAction {
 public:
  enum class End { Succeeded, Aborted, Canceled };
  struct Callbacks {
    /// A goal that is to be followed from now on, in place of the one under way. @returns why not: the result of a
    /// goal that is rejected; without a text, it is accepted
    std::function<FollowJointTrajectoryResult(const FollowJointTrajectoryGoal&)> follow;
    /// The client wants the goal under way to end: joints are to stop.
    std::function<void()> stop;
  };

  TrajectoryAction(ros::NodeHandle& node, Callbacks callbacks);
  ~TrajectoryAction();
  TrajectoryAction(const TrajectoryAction&) = delete;
  TrajectoryAction& operator=(const TrajectoryAction&) = delete;

  bool is_underway() const;
  void publish_feedback(const FollowJointTrajectoryFeedback& feedback);
  /// Ends the goal that is under way, if there is one, with that code and text.
  void end(End how, int code, const std::string& text);

 private:
  struct Server;  // of actionlib, which takes long to compile
  std::unique_ptr<Server> server_;
};

}  // namespace flexarm::node
