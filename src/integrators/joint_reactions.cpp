#include "integrators/joint_reactions.h"

namespace flexarm {

Vector6 JointReactions::transmitted(const ReducedResidual& residual, const ReactionPlace& place) const {
  const Scheme& scheme = configuration_.scheme();
  const int slave = configuration_.model().joints[place.joint].slave;
  const double end = scheme.is_incremental() ? scheme.arm_weight() : 1.0;
  const Vector3 arm = end * (configuration_.end()[slave].rotation * place.arm) +
                      (1 - end) * (configuration_.begin()[slave].rotation * place.arm);
  Vector6 wrench = residual.node(slave);
  wrench.tail<3>() -= arm.cross(wrench.head<3>());
  return wrench / friction_.effort_weight();
}

void JointReactions::accept(const ReducedResidual& residual, State& state) const {
  const std::vector<ReactionPlace>& places = configuration_.model().reactions;
  // The Newmark family has forces at the ends of steps, and none at the start of a simulation.
  const bool is_mean = configuration_.scheme().is_incremental() || state.history.count == 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vector6 now = transmitted(residual, places[i]);
    Eigen::Map<Vector6> last(state.last_transmitted.data() + 6 * i);
    Eigen::Map<Vector6>(state.transmitted.impulse.data() + 6 * i) +=
        configuration_.step() * (is_mean ? now : Vector6(0.5 * (last + now)));
    last = now;
  }
}

void JointReactions::accept_rest(const ReducedResidual& residual, State& state) const {
  const std::vector<ReactionPlace>& places = configuration_.model().reactions;
  for (std::size_t i = 0; i < places.size(); ++i)
    Eigen::Map<Vector6>(state.last_transmitted.data() + 6 * i) = transmitted(residual, places[i]);
  state.transmitted.restart(state.last_transmitted);
}

}  // namespace flexarm
