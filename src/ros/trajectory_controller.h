#pragma once
/// An action to follow trajectories with a group of joints, like that of joint_trajectory_controller.

#include <optional>
#include <string>
#include <vector>

#include "controller_parameters.h"
#include "joint_controller.h"
#include "trajectory_goal.h"

namespace flexarm::node {

/// Makes servos of mode `position` follow the goal's trajectory. Joints that the goal does not name are not affected.
class TrajectoryController : public JointController {
 public:
  TrajectoryController(ros::NodeHandle& node, const ControllerDescription& description, Motions& motions, Take take);

  void judge(double now) override;
  void end(GoalEnd how, const std::string& reason) override;
  bool is_underway() const override { return action_.is_underway(); }
  void renumber(const Renumbering::Places& joints) override;

 private:
  using Server = GoalServer<control::FollowJointTrajectoryAction>;
  using Result = control::FollowJointTrajectoryResult;

  std::optional<Server::Rejection> follow_goal(const control::FollowJointTrajectoryGoal& message);
  void end(GoalEnd how, int code, const std::string& text);
  void publish_feedback(double now);

  std::vector<std::string> group_;            ///< empty: all joints
  TrajectoryGoal goal_;                       ///< the current goal, with the same joints as joints_
  double next_feedback_ = 0;                  ///< simulated time of the next feedback [s]
  std::vector<JointPoint> desired_, actual_;  ///< of the goal's joints
  Server action_;
};

}  // namespace flexarm::node
