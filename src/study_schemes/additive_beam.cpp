#include "study_schemes/additive_beam.h"

#include "elements/orders.h"
#include "math/so3.h"

namespace flexarm {
namespace {

/// Tangent of a stiffness point in the coordinates (r', theta', theta).
using PointMatrix = Eigen::Matrix<double, 9, 9>;

/// Returns d{n, T^T m, T'^T m - T^T (r' x n)}, the sum of the material part and the geometric part G (beam.md 2.2).
/// `n`, `m`: stress resultants in world axes; `theta`, `slope`: the interpolated total rotation vector and its
/// derivative.
PointMatrix point_tangent(const PointKinematics& point, const Matrix6& stiffness, const Vector3& n, const Vector3& m,
                          const Vector3& theta, const Vector3& slope) {
  const so3::ExponentialMap<double> map(theta);
  const Matrix3 T = map.tangent(), T_slope = map.tangent_derivative(slope), arm = so3::hat(point.tangent);
  const Matrix3 turned = point.rotation.transpose();
  Eigen::Matrix<double, 6, 9> strain = Eigen::Matrix<double, 6, 9>::Zero();
  strain.topLeftCorner<3, 3>() = turned;
  strain.topRightCorner<3, 3>() = turned * arm * T;
  strain.block<3, 3>(3, 3) = turned * T;
  strain.bottomRightCorner<3, 3>() = turned * T_slope;
  PointMatrix K = strain.transpose() * stiffness * strain;
  const Vector3 moment = map.rotation().transpose() * m;  // in the frame of the undeformed section
  const Matrix3 force = so3::hat(n), xi = map.xi_tangent(moment);
  K.block<3, 3>(0, 6) -= force * T;
  K.block<3, 3>(6, 0) += T.transpose() * force;
  K.block<3, 3>(3, 6) += xi;
  K.block<3, 3>(6, 3) += xi.transpose();
  K.bottomRightCorner<3, 3>() += so3::xi_second_tangent(theta, moment, slope) + T.transpose() * arm * force * T -
                                 map.xi_tangent_transposed(point.tangent.cross(n));
  return K;
}

/// Adds weight B^T K B. B maps the nodal {r_j, theta_j} to (r', theta', theta).
template <int Nodes>
void add_point_tangent(double weight, const PointMatrix& K, const NodalValues<Nodes>& shape,
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
  const PointMatrix tangent =
      point_tangent(point.kinematics, point.stress_slope * point.stiffness, point.n, point.m, theta, slope);
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

template <int Nodes>
void additive_to_spins(const ElementNodes<Nodes>& nodes, bool with_tangent, ElementSystem<Nodes>& system) {
  for (int i = 0; i < Nodes; ++i) {
    const so3::ExponentialMap<double> map(nodes.rotation_vector[i]), opposite(Vector3(-nodes.rotation_vector[i]));
    const Matrix3 inverse = map.inverse_tangent();
    const Vector3 moment = system.residual.template segment<3>(6 * i + 3);
    system.residual.template segment<3>(6 * i + 3) = inverse.transpose() * moment;
    if (!with_tangent) continue;
    auto rows = system.tangent.template middleRows<3>(6 * i + 3);
    rows = (inverse.transpose() * rows).eval();
    rows.template middleCols<3>(6 * i + 3) -= opposite.xi_inverse_tangent(moment);  // T^{-T}(theta) = T^{-1}(-theta)
  }
  for (int j = 0; j < Nodes && with_tangent; ++j) {
    auto columns = system.tangent.template middleCols<3>(6 * j + 3);
    columns = (columns * so3::inverse_tangent(nodes.rotation_vector[j])).eval();
  }
}

// Explicit instantiations for each order of elements.
#define COMPILE_FOR(Nodes)                                                            \
  template decltype(AdditiveForm::add_point<Nodes>) AdditiveForm::add_point<Nodes>;   \
  template decltype(add_additive_rotary_rate<Nodes>) add_additive_rotary_rate<Nodes>; \
  template decltype(additive_to_spins<Nodes>) additive_to_spins<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
