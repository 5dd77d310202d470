#pragma once
/// An action: one goal at a time, and what its client is told.

#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "control_types.h"

namespace flexarm::node {

/// How a goal ends.
enum class GoalEnd { Succeeded, Aborted, Canceled };

/// Of control::FollowJointTrajectoryAction and control::GripperCommandAction.
template <class Action>
class GoalServer {
 public:
  using Goal = typename Action::_action_goal_type::_goal_type;
  using Result = typename Action::_action_result_type::_result_type;
  using Feedback = typename Action::_action_feedback_type::_feedback_type;
  /// Why a goal is not taken.
  struct Rejection {
    Result result;
    std::string text;
  };
  struct Callbacks {
    /// A goal is to be followed from now on, in place of the one under way.
    std::function<std::optional<Rejection>(const Goal&)> follow;
    /// The goal under way is over: it is to end so, for that reason.
    std::function<void(GoalEnd, const std::string&)> end;
    /// The client wants the goal under way to end: joints are to stop.
    std::function<void()> stop;
  };

  GoalServer(ros::NodeHandle& node, const std::string& name, Callbacks callbacks);
  ~GoalServer();
  GoalServer(const GoalServer&) = delete;
  GoalServer& operator=(const GoalServer&) = delete;

  bool is_underway() const;
  void publish_feedback(const Feedback& feedback);
  /// Ends the goal that is under way, if there is one.
  void end(GoalEnd how, const Result& result, const std::string& text);

 private:
  struct Server;  // of actionlib, which takes long to compile
  std::unique_ptr<Server> server_;
};

}  // namespace flexarm::node
