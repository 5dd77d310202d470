#include "goal_server.h"

#include <actionlib/server/action_server.h>

#include <utility>

namespace flexarm::node {

template <class Action>
struct GoalServer<Action>::Server {
  using ActionServer = actionlib::ActionServer<Action>;
  using Handle = typename ActionServer::GoalHandle;

  Server(ros::NodeHandle& node, const std::string& name, Callbacks of_controller)
      : callbacks(std::move(of_controller)),
        action(
            node, name, [this](Handle goal) { receive(goal); }, [this](Handle goal) { cancel(goal); }, false) {
    action.start();
  }

  void receive(Handle goal) {
    if (const std::optional<Rejection> refused = callbacks.follow(*goal.getGoal()))
      return goal.setRejected(refused->result, refused->text);
    if (underway) callbacks.end(GoalEnd::Canceled, "another goal has replaced it");
    underway = goal;
    underway->setAccepted();
  }

  void cancel(Handle goal) {
    if (!underway || goal != *underway) return;
    callbacks.stop();
    callbacks.end(GoalEnd::Canceled, "cancelled");
  }

  void end(GoalEnd how, const Result& result, const std::string& text) {
    if (!underway) return;
    Handle goal = *std::exchange(underway, std::nullopt);
    switch (how) {
      case GoalEnd::Succeeded:
        return goal.setSucceeded(result, text);
      case GoalEnd::Aborted:
        return goal.setAborted(result, text);
      case GoalEnd::Canceled:
        return goal.setCanceled(result, text);
    }
  }

  Callbacks callbacks;
  std::optional<Handle> underway;
  ActionServer action;
};

template <class Action>
GoalServer<Action>::GoalServer(ros::NodeHandle& node, const std::string& name, Callbacks callbacks)
    : server_(std::make_unique<Server>(node, name, std::move(callbacks))) {}

template <class Action>
GoalServer<Action>::~GoalServer() = default;

template <class Action>
bool GoalServer<Action>::is_underway() const {
  return server_->underway.has_value();
}

template <class Action>
void GoalServer<Action>::publish_feedback(const Feedback& feedback) {
  server_->underway->publishFeedback(feedback);
}

template <class Action>
void GoalServer<Action>::end(GoalEnd how, const Result& result, const std::string& text) {
  server_->end(how, result, text);
}

template class GoalServer<control::FollowJointTrajectoryAction>;
template class GoalServer<control::GripperCommandAction>;

}  // namespace flexarm::node
