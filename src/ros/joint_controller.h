#pragma once
/// What all controllers have: an action for a group of joints, with one goal at a time.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "goal_server.h"
#include "motions.h"

namespace flexarm::node {

class JointController {
 public:
  /// Takes joints from the goals of other controllers, which end.
  using Take = std::function<void(const std::vector<std::size_t>&)>;

  JointController(Motions& motions, Take take) : motions_(motions), take_(std::move(take)) {}
  virtual ~JointController() = default;
  JointController(const JointController&) = delete;
  JointController& operator=(const JointController&) = delete;

  /// Judges the goal under way by what is shown, of the time `now` [s].
  virtual void judge(double now) = 0;
  /// Ends the goal under way, if there is one; what joints do is left to others.
  virtual void end(GoalEnd how, const std::string& reason) = 0;
  virtual bool is_underway() const = 0;
  /// Whether the goal under way is one of that joint.
  bool has_goal_for(std::size_t joint) const {
    return is_underway() && std::find(joints_.begin(), joints_.end(), joint) != joints_.end();
  }
  /// Ends that goal where somebody else commands one of its joints: the others stop.
  void abort(const std::string& reason) {
    motions_.stop(joints_);
    end(GoalEnd::Aborted, reason);
  }

 protected:
  Motions& motions_;
  Take take_;
  std::vector<std::size_t> joints_;  ///< of the goal under way
};

}  // namespace flexarm::node
