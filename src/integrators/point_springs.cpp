#include "integrators/point_springs.h"

#include "flexarm/model/model_error.h"

namespace flexarm {

PointSprings::PointSprings(const StepConfiguration& configuration) : configuration_(configuration) {
  if (configuration.scheme().hht != HhtForm::None && !configuration.model().springs.empty())
    throw ModelError("schemes that interpolate forces in time (hht1, hht2, hht3) have no springs between points");
}

ClosurePoses PointSprings::poses(const LoopClosure& ends, const std::vector<NodePose>& nodes) const {
  return {ends.parent < 0 ? NodePose() : nodes[ends.parent], nodes[ends.child]};
}

CoordinateStep PointSprings::change(const LoopClosure& ends, const ClosurePoses& begin, const ClosurePoses& end) const {
  const Scheme& scheme = configuration_.scheme();
  CoordinateStep change;
  change.begin = spring_length(ends, begin);
  change.end = spring_length(ends, end);
  change.increment = change.end - change.begin;
  change.step = configuration_.step();
  change.at_end = !scheme.is_incremental();
  if (!change.at_end || change.step == 0) return change;
  const std::vector<NodeState>& nodes = configuration_.state().nodes;
  change.gamma = scheme.gamma;
  Vector12 velocity = Vector12::Zero();
  velocity.head<6>() = spatial_velocity(nodes[ends.child]);
  if (ends.parent >= 0) velocity.tail<6>() = spatial_velocity(nodes[ends.parent]);
  change.begin_rate = spring_gradient(ends, begin).dot(velocity);
  return change;
}

void PointSprings::evaluate(Balance& balance) const {
  const Model& model = configuration_.model();
  for (const PointSpring& spring : model.springs) {
    const LoopClosure& ends = model.closures[spring.closure];
    const ClosurePoses begin = poses(ends, configuration_.begin()), end = poses(ends, configuration_.end());
    const SpringAction action = spring_action(spring, ends, begin, end, change(ends, begin, end));
    balance.residual.node(ends.child) += action.child;
    if (ends.parent >= 0) balance.residual.node(ends.parent) += action.parent;
    if (balance.tangent) balance.tangent->add_coupling(spring.closure, action.tangent);
    balance.dissipated += action.dissipated;
  }
}

}  // namespace flexarm
