#pragma once
/// The base class of controllers: an action for a group of joints, with one goal at a time.

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
  /// Takes joints from other controllers, whose goals end.
  using Take = std::function<void(const std::vector<std::size_t>&)>;

  JointController(Motions& motions, Take take) : motions_(motions), take_(std::move(take)) {}
  virtual ~JointController() = default;
  JointController(const JointController&) = delete;
  JointController& operator=(const JointController&) = delete;

  /// Checks the current goal against the node's copy of the simulation, at the simulated time `now` [s].
  virtual void judge(double now) = 0;
  /// Ends the current goal, if there is one; the joints keep moving as they do.
  virtual void end(GoalEnd how, const std::string& reason) = 0;
  virtual bool is_underway() const = 0;
  /// To be called before links come or go. No goal may use a joint that will be gone.
  virtual void renumber(const Renumbering::Places& joints) {
    if (!is_underway()) joints_.clear();
    for (std::size_t& joint : joints_) joint = *joints[joint];
  }
  /// Whether the current goal uses that joint.
  bool has_goal_for(std::size_t joint) const {
    return is_underway() && std::find(joints_.begin(), joints_.end(), joint) != joints_.end();
  }
  /// Aborts the current goal, because one of its joints got a command from elsewhere; the goal's other joints stop.
  void abort(const std::string& reason) {
    motions_.stop(joints_);
    end(GoalEnd::Aborted, reason);
  }

 protected:
  Motions& motions_;
  Take take_;
  std::vector<std::size_t> joints_;  ///< of the current goal
};

}  // namespace flexarm::node
