#include "trajectory_action.h"

#include <actionlib/server/action_server.h>
#include <flexarm/FollowJointTrajectoryAction.h>

#include <optional>
#include <utility>

namespace flexarm::node {

struct TrajectoryAction::Server {
  using Action = actionlib::ActionServer<FollowJointTrajectoryAction>;
  using Goal = Action::GoalHandle;

  Server(ros::NodeHandle& node, Callbacks callbacks)
      : callbacks(std::move(callbacks)),
        action(
            node, "follow_joint_trajectory", [this](Goal goal) { receive(goal); }, [this](Goal goal) { cancel(goal); },
            false) {
    action.start();
  }

  void receive(Goal goal) {
    const FollowJointTrajectoryResult refused = callbacks.follow(*goal.getGoal());
    if (!refused.error_string.empty()) return goal.setRejected(refused, refused.error_string);
    end(End::Canceled, FollowJointTrajectoryResult::SUCCESSFUL, "another goal has replaced it");
    underway = goal;
    underway->setAccepted();
  }

  void cancel(Goal goal) {
    if (!underway || goal != *underway) return;
    callbacks.stop();
    end(End::Canceled, FollowJointTrajectoryResult::SUCCESSFUL, "cancelled");
  }

  void end(End how, int code, const std::string& text) {
    if (!underway) return;
    Goal goal = *std::exchange(underway, std::nullopt);
    FollowJointTrajectoryResult result;
    result.error_code = code;
    result.error_string = text;
    switch (how) {
      case End::Succeeded:
        return goal.setSucceeded(result, text);
      case End::Aborted:
        return goal.setAborted(result, text);
      case End::Canceled:
        return goal.setCanceled(result, text);
    }
  }

  Callbacks callbacks;
  std::optional<Goal> underway;
  Action action;
};

TrajectoryAction::TrajectoryAction(ros::NodeHandle& node, Callbacks callbacks)
    : server_(std::make_unique<Server>(node, std::move(callbacks))) {}

TrajectoryAction::~TrajectoryAction() = default;

bool TrajectoryAction::is_underway() const {
  return server_->underway.has_value();
}

void TrajectoryAction::publish_feedback(const FollowJointTrajectoryFeedback& feedback) {
  server_->underway->publishFeedback(feedback);
}

void TrajectoryAction::end(End how, int code, const std::string& text) {
  server_->end(how, code, text);
}

}  // namespace flexarm::node
