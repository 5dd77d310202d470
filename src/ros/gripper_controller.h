#pragma once
/// A gripper with an action like that of gripper_action_controller.

#include <optional>
#include <string>
#include <vector>

#include "controller_parameters.h"
#include "joint_controller.h"

namespace flexarm::node {

/// Moves one or two joints to a position with a limited effort. If the joints stop before they reach it, the goal is
/// aborted as stalled, and the gripper goes on pressing.
class GripperController : public JointController {
 public:
  GripperController(ros::NodeHandle& node, const ControllerDescription& description, Motions& motions, Take take);

  void judge(double now) override;
  void end(GoalEnd how, const std::string& reason) override;
  bool is_underway() const override { return action_.is_underway(); }
  void renumber(const Renumbering::Places& joints) override;

 private:
  using Server = GoalServer<control::GripperCommandAction>;
  using Result = control::GripperCommandResult;

  std::optional<Server::Rejection> follow_goal(const control::GripperCommandGoal& message);
  /// Target positions of the driven joints for a given position of the gripper.
  /// @throws std::invalid_argument if there is no such joint.
  std::vector<Motions::Target> targets_of(double position) const;
  /// Makes the joints stay where they are.
  void hold();
  /// Position and effort of the gripper at present.
  Result result() const;
  bool is_at_goal() const;
  bool is_moving() const;

  ControllerDescription description_;
  std::vector<Motions::Target> targets_;  ///< of the current goal, with the same joints as joints_
  double last_motion_ = 0;                ///< when a joint moved last, or when the goal began [s]
  bool begins_ = false;                   ///< true until the first judge() of the current goal
  double next_feedback_ = 0;              ///< simulated time of the next feedback [s]
  Server action_;
};

}  // namespace flexarm::node
