#include "integrators/nodal_forces.h"

#include <cassert>

#include "math/cayley.h"
#include "model/carried_origin.h"

namespace flexarm {

NodalForces::NodalForces(const StepConfiguration& configuration, const StepHistories& histories)
    : configuration_(configuration), histories_(histories) {
  const std::vector<NodalInertia>& inertias = configuration.model().inertias;
  for (std::size_t i = 0; i < inertias.size(); ++i)
    if (inertias[i].total_mass > 0) heavy_nodes_.push_back(static_cast<int>(i));
}

PullAction NodalForces::pull(const NodalLoad& load) const {
  const StepConfiguration& step = configuration_;
  return pull_action(load, load.pull.target - world_origin(step.model(), step.state()), step.begin()[load.node],
                     step.end()[load.node], step.step(), load_point(step.scheme()));
}

void NodalForces::add_pull(const NodalLoad& load, Balance& balance) const {
  const PullAction action = pull(load);
  balance.residual.node(load.node) -= histories_.factor * action.wrench;
  if (balance.tangent) balance.tangent->add_to_node(load.node, -histories_.factor * action.derivative);
}

void NodalForces::evaluate(Balance& balance) const {
  for_each_weight([&](int node, const Vector3& weight) { balance.residual.node(node).head<3>() -= weight; });
  for_each_action(configuration_.end(), [&](int node, const LoadAction& action) {
    balance.residual.node(node) -= action.wrench;
    if (!balance.tangent) return;
    Matrix6 tangent = Matrix6::Zero();
    tangent.rightCols<3>() = -action.derivative;
    balance.tangent->add_to_node(node, tangent);
  });
  for (const NodalLoad& wrench : configuration_.state().wrenches)
    if (wrench.pull.acts()) add_pull(wrench, balance);
}

Vector6 NodalForces::loads_on(const std::vector<bool>& links) const {
  assert(links.size() == configuration_.model().links.size());
  const std::vector<NodePose>&begin = configuration_.begin(), &end = configuration_.end();
  const LoadPoint point = load_point(configuration_.scheme());
  const auto is_on = [&](const NodalLoad& load) { return load.link >= 0 && links[load.link]; };
  Vector6 wrench = Vector6::Zero();
  for_each_load([&](const NodalLoad& load, const StepForce& value) {
    if (!is_on(load)) return;
    const double now = histories_.factor * value.at_end;
    wrench += load_action(load, now, begin[load.node].rotation, end[load.node].rotation, point).wrench;
  });
  for (const NodalLoad& load : configuration_.state().wrenches)
    if (is_on(load) && load.pull.acts()) wrench += histories_.factor * pull(load).wrench;
  return wrench;
}

void NodalForces::add_work(double& work) const {
  for_each_load([&](const NodalLoad& load, const StepForce& value) {
    const NodePose &begin = configuration_.begin()[load.node], &end = configuration_.end()[load.node];
    Vector6 wrench, increment;
    increment << end.position - begin.position, configuration_.increments()[load.node];
    if (configuration_.scheme().is_incremental()) {
      wrench = load_action(load, value.mean, begin.rotation, end.rotation, LoadPoint::Mean).wrench;
    } else {  // the mean force, averaged over the directions at both ends
      increment.tail<3>() = cayley::to_rotation_vector(configuration_.increments()[load.node]);
      wrench = 0.5 * (load_action(load, value.mean, begin.rotation, end.rotation, LoadPoint::End).wrench +
                      load_action(load, value.mean, end.rotation, begin.rotation, LoadPoint::End).wrench);
    }
    work += wrench.dot(increment);
  });
  for (const NodalLoad& wrench : configuration_.state().wrenches)
    if (wrench.pull.acts()) work += pull(wrench).work;
}

}  // namespace flexarm
