#pragma once
/// What joints transmit at the end of a step of an explicit scheme. (docs/notes/explicit.md 4)

#include <vector>

#include "joints/articulated_bodies.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// The reactions that sensors measure, and the efforts that hold held joints. Neither acts on the motion.
class ExplicitReactions {
 public:
  explicit ExplicitReactions(const Model& model) : model_(model) {}

  /// Whether the model has any of them.
  bool any() const { return !model_.reactions.empty() || !model_.held.empty(); }
  /// Writes them into the state. `bodies`: those that know what joints transmit. `closures`: per loop closure, the
  /// wrench {force, moment about the node} on its child. `values`: of the model's functions of time, at the end.
  /// The nodes of `state` are those at the end already.
  void accept(const ArticulatedBodies& bodies, const std::vector<Vector6>& closures, const std::vector<double>& values,
              State& state) const;

 private:
  Vector6 transmitted(const ReactionPlace& place, const ArticulatedBodies& bodies,
                      const std::vector<Vector6>& closures) const;
  double held_effort(const HeldJoint& held, const ArticulatedBodies& bodies, const std::vector<double>& values,
                     const State& state) const;

  const Model& model_;
};

}  // namespace flexarm
