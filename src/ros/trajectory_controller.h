#pragma once
/// Trajectories of a group of joints from an action, as joint_trajectory_controller has it.

#include <optional>
#include <string>
#include <vector>

#include "controller_parameters.h"
#include "joint_controller.h"
#include "trajectory_goal.h"

namespace flexarm::node {

/// Lets servos of mode position follow what the action asks for. What a goal does not name goes on as it was.
class TrajectoryController : public JointController {
 public:
  TrajectoryController(ros::NodeHandle& node, const ControllerDescription& description, Motions& motions, Take take);

  void judge(double now) override;
  void end(GoalEnd how, const std::string& reason) override;
  bool is_underway() const override { return action_.is_underway(); }

 private:
  using Server = GoalServer<control::FollowJointTrajectoryAction>;
  using Result = control::FollowJointTrajectoryResult;

  std::optional<Server::Rejection> follow_goal(const control::FollowJointTrajectoryGoal& message);
  void end(GoalEnd how, int code, const std::string& text);
  void publish_feedback(double now);

  std::vector<std::string> group_;            ///< empty: all joints
  TrajectoryGoal goal_;                       ///< under way; has the same joints
  double next_feedback_ = 0;                  ///< [s]
  std::vector<JointPoint> desired_, actual_;  ///< of the goal's joints
  Server action_;
};

}  // namespace flexarm::node
