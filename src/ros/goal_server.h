#pragma once
/// An actionlib server that has one goal at a time.

#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "control_types.h"

namespace flexarm::node {

/// How a goal ends.
enum class GoalEnd { Succeeded, Aborted, Canceled };

/// Instantiated for control::FollowJointTrajectoryAction and control::GripperCommandAction.
template <class Action>
class GoalServer {
 public:
  using Goal = typename Action::_action_goal_type::_goal_type;
  using Result = typename Action::_action_result_type::_result_type;
  using Feedback = typename Action::_action_feedback_type::_feedback_type;
  /// Why a goal is rejected.
  struct Rejection {
    Result result;
    std::string text;
  };
  struct Callbacks {
    /// Starts to follow a new goal, which replaces the current one; or returns why it is rejected.
    std::function<std::optional<Rejection>(const Goal&)> follow;
    /// Ends the current goal in the given way and for the given reason.
    std::function<void(GoalEnd, const std::string&)> end;
    /// Stops the joints, because the client cancels the current goal.
    std::function<void()> stop;
  };

  GoalServer(ros::NodeHandle& node, const std::string& name, Callbacks callbacks);
  ~GoalServer();
  GoalServer(const GoalServer&) = delete;
  GoalServer& operator=(const GoalServer&) = delete;

  bool is_underway() const;
  void publish_feedback(const Feedback& feedback);
  /// Ends the current goal, if there is one.
  void end(GoalEnd how, const Result& result, const std::string& text);

 private:
  struct Server;  // wraps actionlib's server, so that its slow headers are included in one file only
  std::unique_ptr<Server> server_;
};

}  // namespace flexarm::node
