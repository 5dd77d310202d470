#include "integrators/nodal_forces.h"

#include "elements/load.h"
#include "elements/nodal_inertia.h"
#include "math/cayley.h"

namespace flexarm {

void NodalForces::add(int node, const Vector6& force, Eigen::Matrix<double, 6, 3> rotational, bool of_configuration,
                      bool with_tangent, Balance& balance) const {
  if (interpolation_)
    interpolation_->take(node, force, rotational, of_configuration, with_tangent);
  else
    balance.residual.node(node) += force;
  if (with_tangent) Eigen::Map<Matrix6>(balance.tangent->diagonal_block(node)).rightCols<3>() += rotational;
}

void NodalForces::evaluate(Balance& balance) const {
  const Model& model = configuration_.model();
  const Scheme& scheme = configuration_.scheme();
  const std::vector<NodePose>&begin = configuration_.begin(), &end = configuration_.end();
  const Eigen::Matrix<double, 6, 3> none = Eigen::Matrix<double, 6, 3>::Zero();
  for (std::size_t i = 0; i < end.size(); ++i) {
    const NodalInertia& inertia = model.inertias[i];
    const int node = static_cast<int>(i);
    if (inertia.total_mass > 0) {
      Vector6 weight = Vector6::Zero();
      weight.head<3>() = -histories_.factor * inertia.total_mass * model.gravity;
      add(node, weight, none, true, false, balance);
    }
    if (scheme.is_static || inertia.rotary_damping.isZero(0)) continue;
    const Vector3& increment = configuration_.increments()[i];
    const Matrix3 inverse_tangent = balance.tangent ? cayley::inverse_tangent(increment) : Matrix3::Identity();
    const NodalAction damping = nodal_damping_action(
        inertia, scheme,
        {begin[i], end[i], configuration_.state().nodes[i], increment, inverse_tangent, configuration_.step()});
    Eigen::Matrix<double, 6, 3> rotational = none;
    rotational.bottomRows<3>() = damping.rotational;
    add(node, damping.residual, rotational, false, balance.tangent != nullptr, balance);
    balance.dissipated += damping.dissipated;
  }
  const LoadPoint point = scheme.is_incremental() ? LoadPoint::Mean : LoadPoint::End;
  const std::vector<NodePose>& loaded = interpolation_ ? interpolation_->configuration() : end;
  for (const NodalLoad& load : model.loads) {
    const LoadAction action = load_action(load, histories_.factor * histories_.at_point[load.history],
                                          begin[load.node].rotation, loaded[load.node].rotation, point);
    add(load.node, -action.wrench, -action.derivative, true, balance.tangent != nullptr, balance);
  }
}

void NodalForces::add_work(double& work) const {
  for (const NodalLoad& load : configuration_.model().loads) {
    const NodePose &begin = configuration_.begin()[load.node], &end = configuration_.end()[load.node];
    const double value = histories_.at_point[load.history];
    Vector6 wrench, increment;
    increment << end.position - begin.position, configuration_.increments()[load.node];
    if (configuration_.scheme().is_incremental()) {
      wrench = load_action(load, value, begin.rotation, end.rotation, LoadPoint::Mean).wrench;
    } else {  // trapezoidal rule
      increment.tail<3>() = cayley::to_rotation_vector(configuration_.increments()[load.node]);
      wrench =
          0.5 * (load_action(load, value, begin.rotation, end.rotation, LoadPoint::End).wrench +
                 load_action(load, histories_.at_beginning[load.history], end.rotation, begin.rotation, LoadPoint::End)
                     .wrench);
    }
    work += wrench.dot(increment);
  }
}

}  // namespace flexarm
