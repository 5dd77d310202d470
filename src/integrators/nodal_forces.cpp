#include "integrators/nodal_forces.h"

#include <cassert>

#include "elements/nodal_inertia.h"
#include "math/cayley.h"
#include "model/carried_origin.h"

namespace flexarm {

NodalForces::NodalForces(const StepConfiguration& configuration, const StepHistories& histories,
                         HhtInterpolation* interpolation)
    : configuration_(configuration), histories_(histories), interpolation_(interpolation) {
  const std::vector<NodalInertia>& inertias = configuration.model().inertias;
  for (std::size_t i = 0; i < inertias.size(); ++i) {
    if (inertias[i].total_mass > 0) heavy_nodes_.push_back(static_cast<int>(i));
    // In the energy-momentum family, damping is computed together with inertia (ConservingNodes, PlanarBeams).
    if (configuration.scheme().stress == StressRule::Conjugate) continue;
    if (!inertias[i].rotary_damping.isZero(0)) damped_nodes_.push_back(static_cast<int>(i));
  }
}

void NodalForces::add(int node, const Vector6& force, Eigen::Matrix<double, 6, 3> rotational, bool of_configuration,
                      bool with_tangent, Balance& balance) const {
  if (interpolation_)
    interpolation_->take(node, force, rotational, of_configuration, with_tangent);
  else
    balance.residual.node(node) += force;
  if (!with_tangent) return;
  Matrix6 tangent = Matrix6::Zero();
  tangent.rightCols<3>() = rotational;
  balance.tangent->add_to_node(node, tangent);
}

void NodalForces::add_weight(int node, Balance& balance) const {
  const Model& model = configuration_.model();
  const Vector3 weight = -histories_.factor * model.inertias[node].total_mass * model.gravity;
  if (interpolation_)
    interpolation_->take(node, weight);
  else
    balance.residual.node(node).head<3>() += weight;
}

void NodalForces::add_damping(int node, Balance& balance) const {
  const StepConfiguration& step = configuration_;
  const Vector3& increment = step.increments()[node];
  const Matrix3 inverse_tangent = balance.tangent ? cayley::inverse_tangent(increment) : Matrix3::Identity();
  const NodalAction damping = nodal_damping_action(
      step.model().inertias[node], step.scheme(),
      {step.begin()[node], step.end()[node], step.state().nodes[node], increment, inverse_tangent, step.step()},
      balance.tangent != nullptr);
  Eigen::Matrix<double, 6, 3> rotational = Eigen::Matrix<double, 6, 3>::Zero();
  rotational.bottomRows<3>() = damping.rotational;
  add(node, damping.residual, rotational, false, balance.tangent != nullptr, balance);
  balance.dissipated += damping.dissipated;
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

template <class Visit>
void NodalForces::for_each_load(const Visit& visit) const {
  for (const NodalLoad& load : configuration_.model().loads) visit(load, histories_.of_load(load.history));
  for (const NodalLoad& wrench : configuration_.state().wrenches) visit(wrench, StepForce{1.0, 1.0, 1.0});
}

void NodalForces::evaluate(Balance& balance) const {
  const Scheme& scheme = configuration_.scheme();
  for (const int node : heavy_nodes_) add_weight(node, balance);
  if (!scheme.is_static)
    for (const int node : damped_nodes_) add_damping(node, balance);
  const std::vector<NodePose>&begin = configuration_.begin(), &end = configuration_.end();
  const LoadPoint point = load_point(scheme);
  const std::vector<NodePose>& loaded = interpolation_ ? interpolation_->configuration() : end;
  for_each_load([&](const NodalLoad& load, const StepForce& value) {
    const LoadAction action = load_action(load, histories_.factor * value.acting, begin[load.node].rotation,
                                          loaded[load.node].rotation, point);
    add(load.node, -action.wrench, -action.derivative, true, balance.tangent != nullptr, balance);
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
