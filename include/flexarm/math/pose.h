#pragma once
/// A rigid placement: position and orientation of one frame in another.

#include <Eigen/Geometry>

namespace flexarm {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
template <typename S>
using Vector6T = Eigen::Matrix<S, 6, 1>;
template <typename S>
using Matrix6T = Eigen::Matrix<S, 6, 6>;
using Vector6 = Vector6T<double>;
using Matrix6 = Matrix6T<double>;
using Quaternion = Eigen::Quaterniond;

/// Placement of a frame B in a frame A: x_A = position + orientation * x_B. [m], unit quaternion.
struct Pose {
  Vector3 position = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();

  /// Composition: (A<-B) * (B<-C) = (A<-C).
  Pose operator*(const Pose& other) const {
    return {position + orientation * other.position, (orientation * other.orientation).normalized()};
  }
  /// Point given in frame B, returned in frame A.
  Vector3 operator*(const Vector3& point) const { return position + orientation * point; }
  Pose inverse() const {
    const Quaternion conjugate = orientation.conjugate();
    return {conjugate * (-position), conjugate};
  }
};

}  // namespace flexarm
