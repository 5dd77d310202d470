#include "elements/additive_beam.h"

#include "elements/additive_point.h"
#include "elements/orders.h"

namespace flexarm {
namespace {

/// Adds weight B^T K B, B: (r', theta', theta) from the nodal {r_j, theta_j}.
template <int Nodes>
void add_point_tangent(double weight, const additive::PointMatrix& K, const NodalValues<Nodes>& shape,
                       const NodalValues<Nodes>& derivative, Eigen::Matrix<double, 6 * Nodes, 6 * Nodes>& tangent) {
  for (int j = 0; j < Nodes; ++j) {
    Eigen::Matrix<double, 9, 6> columns;
    columns.leftCols<3>() = weight * derivative[j] * K.leftCols<3>();
    columns.rightCols<3>() = weight * (derivative[j] * K.middleCols<3>(3) + shape[j] * K.rightCols<3>());
    for (int i = 0; i < Nodes; ++i) {
      tangent.template block<3, 6>(6 * i, 6 * j) += derivative[i] * columns.topRows<3>();
      tangent.template block<3, 6>(6 * i + 3, 6 * j) +=
          derivative[i] * columns.middleRows<3>(3) + shape[i] * columns.bottomRows<3>();
    }
  }
}

}  // namespace

template <int Nodes>
void AdditiveForm::add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants,
                             const ElementNodes<Nodes>& nodes, const GeneralisedShapeFunctions<Nodes>&,
                             const endpoint::PointForces& point, bool with_tangent, ElementSystem<Nodes>& system) {
  const Vector3 theta = interpolate<Nodes>(constants.shape, nodes.rotation_vector);
  const Vector3 slope = interpolate<Nodes>(constants.derivative, nodes.rotation_vector);
  const so3::ExponentialMap<double> map(theta);
  const Vector3 couple = map.tangent_derivative(slope).transpose() * point.m -
                         map.tangent().transpose() * point.kinematics.tangent.cross(point.n);
  const Vector3 moment = map.tangent().transpose() * point.m;
  for (int i = 0; i < Nodes; ++i) {
    system.residual.template segment<3>(6 * i) += constants.weight * constants.derivative[i] * point.n;
    system.residual.template segment<3>(6 * i + 3) +=
        constants.weight * (constants.derivative[i] * moment + constants.shape[i] * couple);
  }
  if (!with_tangent) return;
  const additive::PointMatrix tangent =
      additive::point_tangent(point.kinematics, point.stress_slope * point.stiffness, point.n, point.m, theta, slope);
  add_point_tangent<Nodes>(constants.weight, tangent, constants.shape, constants.derivative, system.tangent);
}

template <int Nodes>
void add_additive_rotary_rate(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, int k,
                              const RotaryRate& rate, bool with_tangent, ElementSystem<Nodes>& system) {
  const auto& constants = element.mass_points[k];
  const so3::ExponentialMap<double> map(interpolate<Nodes>(constants.shape, nodes.rotation_vector));
  const Matrix3 T = map.tangent();
  const Vector3 moment = T.transpose() * rate.moment;
  for (int i = 0; i < Nodes; ++i)
    system.residual.template segment<3>(6 * i + 3) += constants.weight * constants.shape[i] * moment;
  if (!with_tangent) return;
  const Matrix3 K = T.transpose() * rate.derivative * T + map.xi_tangent_transposed(rate.moment);
  for (int i = 0; i < Nodes; ++i)
    for (int j = 0; j < Nodes; ++j)
      system.tangent.template block<3, 3>(6 * i + 3, 6 * j + 3) +=
          constants.weight * constants.shape[i] * constants.shape[j] * K;
}

// Compiled here once for each order of elements.
#define COMPILE_FOR(Nodes)                                                          \
  template decltype(AdditiveForm::add_point<Nodes>) AdditiveForm::add_point<Nodes>; \
  template decltype(add_additive_rotary_rate<Nodes>) add_additive_rotary_rate<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
