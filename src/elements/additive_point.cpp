#include "elements/additive_point.h"

#include "math/so3.h"

namespace flexarm {

additive::PointMatrix additive::point_tangent(const PointKinematics& point, const Matrix6& stiffness, const Vector3& n,
                                              const Vector3& m, const Vector3& theta, const Vector3& slope) {
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

}  // namespace flexarm
