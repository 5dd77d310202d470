#pragma once
/// Finite rotations by tangent-scaled rotation vectors w = 2 tan(|theta|/2) theta/|theta| (Cayley transform).
///
/// All operators are rational functions, without trigonometry, except the conversions to and from rotation vectors.
/// Conventions as in so3.h: d(cay w) = hat(dvartheta) cay w with dvartheta = S(w) dw. |w| grows without bound as the
/// angle approaches pi. (Muñoz 2004, appendix G)

#include "math/so3.h"

namespace flexarm::cayley {

namespace detail {
/// 1 / (1 + w.w / 4) = cos^2(theta / 2).
template <typename S>
inline S squared_cosine(const Vector3T<S>& w) {
  return S(1) / (S(1) + S(0.25) * so3::dot(w, w));
}
/// I + c w w^T.
template <typename S>
inline Matrix3T<S> identity_plus_dyad(const S& c, const Vector3T<S>& w) {
  Matrix3T<S> result = (c * w) * w.transpose();
  result.diagonal().array() += S(1);
  return result;
}
}  // namespace detail

/// cay(w) = (I - hat(w)/2)^-1 (I + hat(w)/2).
template <typename V>
inline Matrix3T<typename V::Scalar> rotation(const Eigen::MatrixBase<V>& w) {
  using S = typename V::Scalar;
  const Vector3T<S> t = w;
  const S c = detail::squared_cosine(t);
  return so3::detail::identity_plus<S>(c, S(0.5) * c, t);
}

/// Unit quaternion (1, w/2) / |(1, w/2)|; q0 > 0.
template <typename V>
inline QuaternionT<typename V::Scalar> quaternion(const Eigen::MatrixBase<V>& w) {
  using std::sqrt;
  using S = typename V::Scalar;
  const S q0 = sqrt(detail::squared_cosine(Vector3T<S>(w)));
  const S half = S(0.5) * q0;
  return QuaternionT<S>(q0, half * w[0], half * w[1], half * w[2]);
}

/// Unit quaternion of half the rotation of w.
template <typename V>
inline QuaternionT<typename V::Scalar> half_quaternion(const Eigen::MatrixBase<V>& w) {
  using std::sqrt;
  using S = typename V::Scalar;
  const S cosine = sqrt(detail::squared_cosine(Vector3T<S>(w)));
  const S q0 = sqrt(S(0.5) * (S(1) + cosine));
  const S scale = S(0.25) * cosine / q0;
  return QuaternionT<S>(q0, scale * w[0], scale * w[1], scale * w[2]);
}

/// P = I + (cos(theta/2) - 1) e e^T for the angle theta about e. (I + hat(w)/2) cos(theta/2) is P times half the
/// rotation of w.
template <typename V>
inline Matrix3T<typename V::Scalar> axial_stretch(const Eigen::MatrixBase<V>& w) {
  using std::sqrt;
  using S = typename V::Scalar;
  const S cosine = sqrt(detail::squared_cosine(Vector3T<S>(w)));
  return detail::identity_plus_dyad<S>(S(-0.25) * cosine * cosine / (S(1) + cosine), w);
}

/// P^-1.
template <typename V>
inline Matrix3T<typename V::Scalar> inverse_axial_stretch(const Eigen::MatrixBase<V>& w) {
  using std::sqrt;
  using S = typename V::Scalar;
  const S cosine = sqrt(detail::squared_cosine(Vector3T<S>(w)));
  return detail::identity_plus_dyad<S>(S(0.25) * cosine / (S(1) + cosine), w);
}

/// Tangent-scaled vector 2 q_v / q_0 of a quaternion of any norm and sign; unbounded as the angle approaches pi.
template <typename Q>
inline Vector3T<typename Q::Scalar> increment(const Eigen::QuaternionBase<Q>& quaternion) {
  using S = typename Q::Scalar;
  const S scale = S(2) / quaternion.w();
  return {scale * quaternion.x(), scale * quaternion.y(), scale * quaternion.z()};
}

/// Returns the spatial increment w with cay(w) = to from^-1, for quaternions of any norm. It is computed from
/// d = to - from, since to from* = |from|^2 + d from*. So it is exactly zero for equal quaternions, also with fused
/// multiply-add, and the round-off is smaller for smaller rotations.
template <typename P, typename Q>
inline Vector3T<typename P::Scalar> increment(const Eigen::QuaternionBase<P>& from,
                                              const Eigen::QuaternionBase<Q>& to) {
  using S = typename P::Scalar;
  const Vector3T<S> v(from.x(), from.y(), from.z());
  const Vector3T<S> d(to.x() - from.x(), to.y() - from.y(), to.z() - from.z());
  const S d0 = to.w() - from.w();
  const S product = from.w() * to.w() + from.x() * to.x() + from.y() * to.y() + from.z() * to.z();
  return (S(2) / product) * (from.w() * d - d0 * v - so3::cross(d, v));
}

/// S(w) = (I + hat(w)/2) / (1 + w.w/4): spatial spin per change of w.
template <typename V>
inline Matrix3T<typename V::Scalar> tangent(const Eigen::MatrixBase<V>& w) {
  using S = typename V::Scalar;
  const Vector3T<S> t = w;
  const S c = detail::squared_cosine(t);
  Matrix3T<S> result = so3::hat(Vector3T<S>((S(0.5) * c) * t));
  result.diagonal().setConstant(c);
  return result;
}

/// S(w)^-1 = I - hat(w)/2 + w w^T/4.
template <typename V>
inline Matrix3T<typename V::Scalar> inverse_tangent(const Eigen::MatrixBase<V>& w) {
  using S = typename V::Scalar;
  const Vector3T<S> t = w;
  Matrix3T<S> result = (S(0.25) * t) * t.transpose();
  result += so3::hat(Vector3T<S>(S(-0.5) * t));
  result.diagonal().array() += S(1);
  return result;
}

/// S' = d/ds S(w(s)) for dw = d/ds w.
template <typename V, typename D>
inline Matrix3T<typename V::Scalar> tangent_derivative(const Eigen::MatrixBase<V>& w, const Eigen::MatrixBase<D>& dw) {
  using S = typename V::Scalar;
  const Vector3T<S> t = w;
  const S half = S(0.5) * detail::squared_cosine(t);
  return so3::hat(Vector3T<S>(half * dw)) - (half * so3::dot(t, dw)) * tangent(t);
}

/// (S^-1)' = d/ds S(w(s))^-1.
template <typename V, typename D>
inline Matrix3T<typename V::Scalar> inverse_tangent_derivative(const Eigen::MatrixBase<V>& w,
                                                               const Eigen::MatrixBase<D>& dw) {
  using S = typename V::Scalar;
  const Matrix3T<S> product = (S(0.25) * dw) * w.transpose();
  return product + product.transpose() - so3::hat(Vector3T<S>(S(0.5) * dw));
}

/// Xi with d(S(w) a) = Xi dw for constant a.
template <typename V, typename A>
inline Matrix3T<typename V::Scalar> xi_tangent(const Eigen::MatrixBase<V>& w, const Eigen::MatrixBase<A>& a) {
  using S = typename V::Scalar;
  const Vector3T<S> t = w;
  const S half = S(0.5) * detail::squared_cosine(t);
  const Vector3T<S> image = tangent(t) * a;
  return -so3::hat(Vector3T<S>(half * a)) - (half * image) * t.transpose();
}

/// Xi with d(S(w)^T a) = Xi dw for constant a.
template <typename V, typename A>
inline Matrix3T<typename V::Scalar> xi_tangent_transposed(const Eigen::MatrixBase<V>& w,
                                                          const Eigen::MatrixBase<A>& a) {
  using S = typename V::Scalar;
  const Vector3T<S> t = w;
  const S half = S(0.5) * detail::squared_cosine(t);
  const Vector3T<S> image = tangent(t).transpose() * a;
  return so3::hat(Vector3T<S>(half * a)) - (half * image) * t.transpose();
}

/// Xi with d(S(w)^-1 a) = Xi dw for constant a.
template <typename V, typename A>
inline Matrix3T<typename V::Scalar> xi_inverse_tangent(const Eigen::MatrixBase<V>& w, const Eigen::MatrixBase<A>& a) {
  using S = typename V::Scalar;
  Matrix3T<S> result = so3::hat(Vector3T<S>(S(0.5) * a)) + (S(0.25) * w) * a.transpose();
  result.diagonal().array() += S(0.25) * so3::dot(w, a);
  return result;
}

/// w21 with cay(w21) = cay(w2) cay(w1); singular where the composed angle is pi (w1.w2 = 4).
template <typename V, typename U>
inline Vector3T<typename V::Scalar> compound(const Eigen::MatrixBase<V>& w2, const Eigen::MatrixBase<U>& w1) {
  using S = typename V::Scalar;
  const S kappa = S(1) / (S(1) - S(0.25) * so3::dot(w1, w2));
  return kappa * (w2 + w1 + S(0.5) * so3::cross(w2, w1));
}

/// w of a rotation vector theta; singular at |theta| = pi, beyond which it is the w of the shorter rotation.
template <typename V>
inline Vector3T<typename V::Scalar> from_rotation_vector(const Eigen::MatrixBase<V>& theta) {
  return increment(so3::exp_quaternion(theta));
}

/// Rotation vector, |theta| < pi, of w.
template <typename V>
inline Vector3T<typename V::Scalar> to_rotation_vector(const Eigen::MatrixBase<V>& w) {
  return so3::log(quaternion(w));
}

/// U(w) with dw = U dtheta, where theta is the rotation vector of w:
/// U = (1 + w.w/4) e e^T + (|w|/2) / arctan(|w|/2) (I - e e^T). The sign inside the first bracket is plus; (G.24) of
/// Muñoz 2004 prints a minus. It is evaluated as S^-1 T (dvartheta = T dtheta = S dw), which has no 0/0 at w = 0.
template <typename V>
inline Matrix3T<typename V::Scalar> scaling_derivative(const Eigen::MatrixBase<V>& w) {
  return inverse_tangent(w) * so3::tangent(to_rotation_vector(w));
}

/// U(w)^-1, with dtheta = U^-1 dw: e e^T / (1 + w.w/4) + arctan(|w|/2) / (|w|/2) (I - e e^T), evaluated as T^-1 S.
template <typename V>
inline Matrix3T<typename V::Scalar> inverse_scaling_derivative(const Eigen::MatrixBase<V>& w) {
  return so3::inverse_tangent(to_rotation_vector(w)) * tangent(w);
}

}  // namespace flexarm::cayley
