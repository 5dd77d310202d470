#pragma once
/// Finite rotations by the four components q = (q_0, q_v) of a unit quaternion (Euler parameters), scalar part first.
///
/// They have no singularities, but a fourth component and the constraint q.q = 1. q and -q are the same rotation.
/// Conventions as in so3.h: d(Lambda) = hat(dvartheta) Lambda with dvartheta = T(q) dq = 2 G(q) dq,
///     G(q) = [-q_v, q_0 I + hat(q_v)]  (3 x 4),   G q = 0,   G G^T = I,   G^T G = I - q q^T.
/// So T maps changes of the norm to zero. T^-1 = G^T/2 (4 x 3) is a right inverse of T, whose columns are tangent to
/// the unit sphere: T^-1 T dq = dq for q.dq = 0. All operators are polynomials of q; their derivatives are with respect
/// to four independent components. (Nikravesh 1988, ch. 6; G is his matrix of spatial angular velocities)

#include "math/so3.h"

namespace flexarm::unit_quaternion {

template <typename S>
using Vector4T = Eigen::Matrix<S, 4, 1>;
template <typename S>
using Matrix4T = Eigen::Matrix<S, 4, 4>;
template <typename S>
using Matrix34T = Eigen::Matrix<S, 3, 4>;
template <typename S>
using Matrix43T = Eigen::Matrix<S, 4, 3>;

namespace detail {
template <typename Q>
inline Vector3T<typename Q::Scalar> vector_part(const Eigen::MatrixBase<Q>& q) {
  return {q[1], q[2], q[3]};
}

/// p . q without conjugation.
template <typename P, typename Q>
inline typename P::Scalar dot(const Eigen::MatrixBase<P>& p, const Eigen::MatrixBase<Q>& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
}

/// d(Lambda(q) a)/dq for sign = 1, d(Lambda(q)^T a)/dq for sign = -1.
template <typename S>
inline Matrix34T<S> xi_rotation(const Vector4T<S>& q, const S& sign, const Vector3T<S>& a) {
  const Vector3T<S> v = sign * vector_part(q);
  const Vector3T<S> first = S(2) * (q[0] * a + so3::cross(v, a));
  // v a^T - a v^T = hat(a x v).
  Matrix3T<S> rest = so3::hat(Vector3T<S>(S(2) * (so3::cross(a, v) - q[0] * a)));
  rest.diagonal().array() += S(2) * so3::dot(v, a);
  Matrix34T<S> result;
  result << first, sign * rest;
  return result;
}
}  // namespace detail

/// Components (w, x, y, z) of a quaternion, and back; neither changes norm or sign.
template <typename Q>
inline Vector4T<typename Q::Scalar> from_quaternion(const Eigen::QuaternionBase<Q>& quaternion) {
  return {quaternion.w(), quaternion.x(), quaternion.y(), quaternion.z()};
}
template <typename Q>
inline QuaternionT<typename Q::Scalar> quaternion(const Eigen::MatrixBase<Q>& q) {
  return {q[0], q[1], q[2], q[3]};
}

/// q of a rotation vector of any length.
template <typename V>
inline Vector4T<typename V::Scalar> from_rotation_vector(const Eigen::MatrixBase<V>& theta) {
  return from_quaternion(so3::exp_quaternion(theta));
}

/// Rotation vector, |theta| <= pi, of q of any norm and sign.
template <typename Q>
inline Vector3T<typename Q::Scalar> to_rotation_vector(const Eigen::MatrixBase<Q>& q) {
  return so3::log(quaternion(q));
}

/// q / |q|.
template <typename Q>
inline Vector4T<typename Q::Scalar> normalised(const Eigen::MatrixBase<Q>& q) {
  using std::sqrt;
  using S = typename Q::Scalar;
  return (S(1) / sqrt(detail::dot(q, q))) * q;
}

/// d(q/|q|)/dq = (I - n n^T) / |q| with n = q/|q|. For interpolated quaternions, whose norm is below 1.
template <typename Q>
inline Matrix4T<typename Q::Scalar> normalisation_derivative(const Eigen::MatrixBase<Q>& q) {
  using std::sqrt;
  using S = typename Q::Scalar;
  const S scale = S(1) / sqrt(detail::dot(q, q));
  const Vector4T<S> n = scale * q;
  Matrix4T<S> result = (-scale * n) * n.transpose();
  result.diagonal().array() += scale;
  return result;
}

/// Lambda(q) = (q_0^2 - q_v.q_v) I + 2 q_v q_v^T + 2 q_0 hat(q_v); times |q|^2 if q is not of unit norm.
template <typename Q>
inline Matrix3T<typename Q::Scalar> rotation(const Eigen::MatrixBase<Q>& q) {
  using S = typename Q::Scalar;
  const Vector3T<S> v = detail::vector_part(q);
  Matrix3T<S> result = (S(2) * v) * v.transpose();
  result += so3::hat(Vector3T<S>((S(2) * q[0]) * v));
  result.diagonal().array() += q[0] * q[0] - so3::dot(v, v);
  return result;
}

/// Quaternion product q21 = q2 q1, for which Lambda(q21) = Lambda(q2) Lambda(q1). Normalise after many products.
template <typename P, typename Q>
inline Vector4T<typename P::Scalar> compound(const Eigen::MatrixBase<P>& q2, const Eigen::MatrixBase<Q>& q1) {
  using S = typename P::Scalar;
  const Vector3T<S> v2 = detail::vector_part(q2), v1 = detail::vector_part(q1);
  const Vector3T<S> v = q2[0] * v1 + q1[0] * v2 + so3::cross(v2, v1);
  return {q2[0] * q1[0] - so3::dot(v2, v1), v[0], v[1], v[2]};
}

/// (q_0, -q_v), the quaternion of Lambda^T.
template <typename Q>
inline Vector4T<typename Q::Scalar> conjugate(const Eigen::MatrixBase<Q>& q) {
  return {q[0], -q[1], -q[2], -q[3]};
}

/// T(q) = 2 G(q) = 2 [-q_v, q_0 I + hat(q_v)]: spatial spin per change of q.
template <typename Q>
inline Matrix34T<typename Q::Scalar> tangent(const Eigen::MatrixBase<Q>& q) {
  using S = typename Q::Scalar;
  const Vector4T<S> t = S(2) * q;
  Matrix34T<S> result;
  result << -t[1], t[0], -t[3], t[2], -t[2], t[3], t[0], -t[1], -t[3], -t[2], t[1], t[0];
  return result;
}

/// Lambda^T T(q) = 2 [-q_v, q_0 I - hat(q_v)]: material spin per change of q, curvature per derivative of q.
template <typename Q>
inline Matrix34T<typename Q::Scalar> material_tangent(const Eigen::MatrixBase<Q>& q) {
  using S = typename Q::Scalar;
  const Vector4T<S> t = S(2) * q;
  Matrix34T<S> result;
  result << -t[1], t[0], t[3], -t[2], -t[2], -t[3], t[0], t[1], -t[3], t[2], -t[1], t[0];
  return result;
}

/// T(q)^-1 = G(q)^T / 2: change of q per spatial spin, dq = 1/2 (0, dvartheta) q.
template <typename Q>
inline Matrix43T<typename Q::Scalar> inverse_tangent(const Eigen::MatrixBase<Q>& q) {
  using S = typename Q::Scalar;
  return S(0.25) * tangent(q).transpose();
}

/// Xi with d(T(q) a) = Xi dq for a constant a of four components. T is linear: T' = T(q'), (T^-1)' = T^-1(q'), and
/// T(q) a = -T(a) q.
template <typename A>
inline Matrix34T<typename A::Scalar> xi_tangent(const Eigen::MatrixBase<A>& a) {
  return -tangent(a);
}

/// Xi with d(T(q)^T a) = Xi dq for a constant a of three components: 2 [0, -a^T; a, hat(a)].
template <typename A>
inline Matrix4T<typename A::Scalar> xi_tangent_transposed(const Eigen::MatrixBase<A>& a) {
  using S = typename A::Scalar;
  const Vector3T<S> t = S(2) * a;
  Matrix4T<S> result;
  result << S(0), -t.transpose(), t, so3::hat(t);
  return result;
}

/// Xi with d(T(q)^-1 a) = Xi dq for a constant a of three components: 1/2 [0, -a^T; a, hat(a)].
template <typename A>
inline Matrix4T<typename A::Scalar> xi_inverse_tangent(const Eigen::MatrixBase<A>& a) {
  using S = typename A::Scalar;
  return S(0.25) * xi_tangent_transposed(a);
}

/// Xi with d(Lambda(q) a) = Xi dq for constant a: 2 [q_0 a + q_v x a, q_v.a I + q_v a^T - a q_v^T - q_0 hat(a)].
template <typename Q, typename A>
inline Matrix34T<typename Q::Scalar> xi_rotation(const Eigen::MatrixBase<Q>& q, const Eigen::MatrixBase<A>& a) {
  using S = typename Q::Scalar;
  return detail::xi_rotation<S>(q, S(1), a);
}

/// Xi with d(Lambda(q)^T a) = Xi dq for constant a.
template <typename Q, typename A>
inline Matrix34T<typename Q::Scalar> xi_rotation_transposed(const Eigen::MatrixBase<Q>& q,
                                                            const Eigen::MatrixBase<A>& a) {
  using S = typename Q::Scalar;
  return detail::xi_rotation<S>(q, S(-1), a);
}

}  // namespace flexarm::unit_quaternion
