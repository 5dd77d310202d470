#pragma once
/// A gripper with an action, as gripper_action_controller has it.

#include <optional>
#include <string>
#include <vector>

#include "controller_parameters.h"
#include "joint_controller.h"

namespace flexarm::node {

/// Lets one or two joints go to a position with a limited effort. Where they do not move any more before they are
/// there, the goal is aborted as stalled; they go on pressing.
class GripperController : public JointController {
 public:
  GripperController(ros::NodeHandle& node, const ControllerDescription& description, Motions& motions, Take take);

  void judge(double now) override;
  void end(GoalEnd how, const std::string& reason) override;
  bool is_underway() const override { return action_.is_underway(); }

 private:
  using Server = GoalServer<control::GripperCommandAction>;
  using Result = control::GripperCommandResult;

  std::optional<Server::Rejection> follow_goal(const control::GripperCommandGoal& message);
  /// Where the joints that are driven are to be for that position of the gripper.
  /// @throws std::invalid_argument if there is no such joint.
  std::vector<Motions::Target> targets_of(double position) const;
  /// Joints stay where they are.
  void hold();
  /// Of the gripper as it is.
  Result result() const;
  bool is_at_goal() const;
  bool is_moving() const;

  ControllerDescription description_;
  std::vector<Motions::Target> targets_;  ///< of the goal under way
  double last_motion_ = 0;                ///< when joints have moved, or the goal began [s]
  bool begins_ = false;                   ///< nothing was judged yet
  double next_feedback_ = 0;              ///< [s]
  Server action_;
};

}  // namespace flexarm::node
