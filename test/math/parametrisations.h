#pragma once
/// Gives the four parametrisations of rotations the same names, for tests that run over all of them. Every function is
/// generic in the scalar type.
/// generic in the scalar.

#include <cmath>

#include "math/cayley.h"
#include "math/conformal.h"
#include "math/so3.h"
#include "math/unit_quaternion.h"

#include "rotation_samples.h"

namespace flexarm::test {

/// The rotation vector theta.
struct RotationVector {
  static constexpr int components = 3;
  static constexpr double largest_angle = 2 * pi - 1e-3;
  /// Size of the terms from which operators are computed. Here they are of order one. Towards 2 pi they cancel, where T
  /// is singular.
  static constexpr double term_size = 1;
  /// Returns the relative change of the vector, or of its derivative, per relative error of a quaternion or angle.
  static double conversion_condition(double) { return 1; }
  /// Returns the relative error of T^-1 and its derivatives per relative error of their terms. T is singular at 2 pi,
  /// and b contains 1/a_1 = theta^2 / (2 sin^2(theta/2)), where the sine has an absolute error.
  static double inverse_condition(double angle) { return angle < pi ? 1 : 1 / std::sin(0.5 * angle); }

  /// Returns the coordinates of a rotation about a unit axis.
  template <typename S>
  static Vector3T<S> make(const Vector3T<S>& axis, S angle) {
    return angle * axis;
  }
  static constexpr auto from_rotation_vector = [](const auto& theta) { return theta; };
  static constexpr auto to_rotation_vector = [](const auto& v) { return v; };
  static constexpr auto from_quaternion = [](const auto& q) { return so3::log(q); };
  static constexpr auto quaternion = [](const auto& v) { return so3::exp_quaternion(v); };
  static constexpr auto rotation = [](const auto& v) { return so3::exp(v); };
  static constexpr auto compound = [](const auto& v2, const auto& v1) { return so3::compound(v2, v1); };
  static constexpr auto tangent = [](const auto& v) { return so3::tangent(v); };
  static constexpr auto inverse_tangent = [](const auto& v) { return so3::inverse_tangent(v); };
  static constexpr auto tangent_derivative = [](const auto& v, const auto& d) { return so3::tangent_derivative(v, d); };
  static constexpr auto inverse_tangent_derivative = [](const auto& v, const auto& d) {
    return so3::inverse_tangent_derivative(v, d);
  };
  static constexpr auto xi_tangent = [](const auto& v, const auto& a) { return so3::xi_tangent(v, a); };
  static constexpr auto xi_tangent_transposed = [](const auto& v, const auto& a) {
    return so3::xi_tangent_transposed(v, a);
  };
  static constexpr auto xi_inverse_tangent = [](const auto& v, const auto& a) { return so3::xi_inverse_tangent(v, a); };
};

/// The tangent-scaled vector w = 2 tan(theta/2) e.
struct TangentScaled {
  static constexpr int components = 3;
  static constexpr double largest_angle = pi - 1e-9;
  /// No terms cancel.
  static constexpr double term_size = 0;
  /// The vector is w = 2 q_v/q_0, and q_0 = cos(theta/2) has an absolute error.
  static double conversion_condition(double angle) { return 1 / std::cos(0.5 * angle); }
  static double inverse_condition(double) { return 1; }

  template <typename S>
  static Vector3T<S> make(const Vector3T<S>& axis, S angle) {
    return (2 * std::tan(angle / 2)) * axis;
  }
  static constexpr auto from_rotation_vector = [](const auto& theta) { return cayley::from_rotation_vector(theta); };
  static constexpr auto to_rotation_vector = [](const auto& v) { return cayley::to_rotation_vector(v); };
  static constexpr auto from_quaternion = [](const auto& q) { return cayley::increment(q); };
  static constexpr auto quaternion = [](const auto& v) { return cayley::quaternion(v); };
  static constexpr auto rotation = [](const auto& v) { return cayley::rotation(v); };
  static constexpr auto compound = [](const auto& v2, const auto& v1) { return cayley::compound(v2, v1); };
  static constexpr auto tangent = [](const auto& v) { return cayley::tangent(v); };
  static constexpr auto inverse_tangent = [](const auto& v) { return cayley::inverse_tangent(v); };
  static constexpr auto tangent_derivative = [](const auto& v, const auto& d) {
    return cayley::tangent_derivative(v, d);
  };
  static constexpr auto inverse_tangent_derivative = [](const auto& v, const auto& d) {
    return cayley::inverse_tangent_derivative(v, d);
  };
  static constexpr auto xi_tangent = [](const auto& v, const auto& a) { return cayley::xi_tangent(v, a); };
  static constexpr auto xi_tangent_transposed = [](const auto& v, const auto& a) {
    return cayley::xi_tangent_transposed(v, a);
  };
  static constexpr auto xi_inverse_tangent = [](const auto& v, const auto& a) {
    return cayley::xi_inverse_tangent(v, a);
  };
};

/// The conformal vector c = 4 tan(theta/4) e.
struct Conformal {
  static constexpr int components = 3;
  static constexpr double largest_angle = 2 * pi - 1e-3;
  /// No terms cancel.
  static constexpr double term_size = 0;
  /// tan(theta/4) magnifies errors of the angle towards 2 pi.
  static double conversion_condition(double angle) { return 1 / std::cos(0.25 * angle); }
  static double inverse_condition(double) { return 1; }

  template <typename S>
  static Vector3T<S> make(const Vector3T<S>& axis, S angle) {
    return (4 * std::tan(angle / 4)) * axis;
  }
  static constexpr auto from_rotation_vector = [](const auto& theta) { return conformal::from_rotation_vector(theta); };
  static constexpr auto to_rotation_vector = [](const auto& v) { return conformal::to_rotation_vector(v); };
  static constexpr auto from_quaternion = [](const auto& q) { return conformal::from_quaternion(q); };
  static constexpr auto quaternion = [](const auto& v) { return conformal::quaternion(v); };
  static constexpr auto rotation = [](const auto& v) { return conformal::rotation(v); };
  static constexpr auto compound = [](const auto& v2, const auto& v1) { return conformal::compound(v2, v1); };
  static constexpr auto tangent = [](const auto& v) { return conformal::tangent(v); };
  static constexpr auto inverse_tangent = [](const auto& v) { return conformal::inverse_tangent(v); };
  static constexpr auto tangent_derivative = [](const auto& v, const auto& d) {
    return conformal::tangent_derivative(v, d);
  };
  static constexpr auto inverse_tangent_derivative = [](const auto& v, const auto& d) {
    return conformal::inverse_tangent_derivative(v, d);
  };
  static constexpr auto xi_tangent = [](const auto& v, const auto& a) { return conformal::xi_tangent(v, a); };
  static constexpr auto xi_tangent_transposed = [](const auto& v, const auto& a) {
    return conformal::xi_tangent_transposed(v, a);
  };
  static constexpr auto xi_inverse_tangent = [](const auto& v, const auto& a) {
    return conformal::xi_inverse_tangent(v, a);
  };
};

/// The unit quaternion q = (cos(theta/2), sin(theta/2) e).
struct UnitQuaternion {
  static constexpr int components = 4;
  static constexpr double largest_angle = 2 * pi - 1e-3;
  /// No terms cancel.
  static constexpr double term_size = 0;
  static double conversion_condition(double) { return 1; }
  static double inverse_condition(double) { return 1; }

  template <typename S>
  static Eigen::Matrix<S, 4, 1> make(const Vector3T<S>& axis, S angle) {
    Eigen::Matrix<S, 4, 1> q;
    q << std::cos(angle / 2), std::sin(angle / 2) * axis;
    return q;
  }
  static constexpr auto from_rotation_vector = [](const auto& theta) {
    return unit_quaternion::from_rotation_vector(theta);
  };
  static constexpr auto to_rotation_vector = [](const auto& v) { return unit_quaternion::to_rotation_vector(v); };
  /// q and -q are the same rotation. The quaternion with q_0 >= 0 is returned, as by the other parametrisations.
  static constexpr auto from_quaternion = [](const auto& q) {
    using S = typename std::decay_t<decltype(q)>::Scalar;
    return unit_quaternion::Vector4T<S>(S(std::real(q.w()) < 0 ? -1 : 1) * unit_quaternion::from_quaternion(q));
  };
  static constexpr auto quaternion = [](const auto& v) { return unit_quaternion::quaternion(v); };
  static constexpr auto rotation = [](const auto& v) { return unit_quaternion::rotation(v); };
  static constexpr auto compound = [](const auto& v2, const auto& v1) { return unit_quaternion::compound(v2, v1); };
  static constexpr auto tangent = [](const auto& v) { return unit_quaternion::tangent(v); };
  static constexpr auto inverse_tangent = [](const auto& v) { return unit_quaternion::inverse_tangent(v); };
  static constexpr auto tangent_derivative = [](const auto&, const auto& d) { return unit_quaternion::tangent(d); };
  static constexpr auto inverse_tangent_derivative = [](const auto&, const auto& d) {
    return unit_quaternion::inverse_tangent(d);
  };
  static constexpr auto xi_tangent = [](const auto&, const auto& a) { return unit_quaternion::xi_tangent(a); };
  static constexpr auto xi_tangent_transposed = [](const auto&, const auto& a) {
    return unit_quaternion::xi_tangent_transposed(a);
  };
  static constexpr auto xi_inverse_tangent = [](const auto&, const auto& a) {
    return unit_quaternion::xi_inverse_tangent(a);
  };
};

}  // namespace flexarm::test
