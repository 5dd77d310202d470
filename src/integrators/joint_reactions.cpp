#include "integrators/joint_reactions.h"

#include <cassert>

namespace flexarm {

Vector6 JointReactions::transmitted(const ReducedResidual& residual, const ReactionPlace& place) const {
  assert(place.joint >= 0 || place.closure >= 0);
  const Model& model = configuration_.model();
  int node;
  Vector6 wrench;
  double end, weight;  // weight of the end of the step in arms; weight of the wrench in the balance
  if (place.closure >= 0) {
    node = model.closures[place.closure].child;
    wrench = -loops_.on_child(place.closure);
    end = loops_.end_weight();
    weight = 1;
  } else {
    node = model.joints[place.joint].slave;
    wrench = residual.node(node);
    end = configuration_.scheme().arm_weight();
    weight = configuration_.effort_weight();
  }
  const auto arm_in = [&](const std::vector<NodePose>& nodes) {
    const NodePose carrier = place.point.node < 0 ? NodePose() : nodes[place.point.node];
    return Vector3(carrier.position - nodes[node].position + carrier.rotation * place.point.offset.position);
  };
  const Vector3 arm = end * arm_in(configuration_.end()) + (1 - end) * arm_in(configuration_.begin());
  wrench.tail<3>() -= arm.cross(wrench.head<3>());
  return (place.is_reversed ? -1 : 1) * wrench / weight;
}

void JointReactions::accept(const ReducedResidual& residual, State& state) const {
  assert(state.last_transmitted.size() == 6 * configuration_.model().reactions.size());
  const std::vector<ReactionPlace>& places = configuration_.model().reactions;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vector6 now = transmitted(residual, places[i]);
    Eigen::Map<Vector6> last(state.last_transmitted.data() + 6 * i);
    Eigen::Map<Vector6>(state.transmitted.impulse.data() + 6 * i) +=
        configuration_.step() * (configuration_.forces_are_means() ? now : Vector6(0.5 * (last + now)));
    last = now;
  }
}

void JointReactions::accept_rest(const ReducedResidual& residual, State& state) const {
  assert(state.last_transmitted.size() == 6 * configuration_.model().reactions.size());
  const std::vector<ReactionPlace>& places = configuration_.model().reactions;
  for (std::size_t i = 0; i < places.size(); ++i)
    Eigen::Map<Vector6>(state.last_transmitted.data() + 6 * i) = transmitted(residual, places[i]);
  state.transmitted.restart(state.last_transmitted);
}

}  // namespace flexarm
