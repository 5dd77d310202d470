#pragma once
/// Finite rotations by conformal rotation vectors c = 4 tan(|theta|/4) theta/|theta| (Wiener-Milenkovic parameters).
///
/// Rational like cayley.h, but regular at pi: |c| grows without bound only at 2 pi. c and its shadow -16 c / |c|^2 are
/// the same rotation; the one with |c| <= 4 has the angle <= pi. With x = c.c/16 = tan^2(theta/4) and H = cay(c/2), the
/// rotation by half the angle,
///     Lambda = H^2,   q = (1 - x, c/2) / (1 + x),   T = H / (1 + x).
/// T is a multiple of a rotation, so it preserves angles (hence the name), and T^-1 = (1 + x) H^T is a polynomial of c.
/// (T follows from spin = 2 (q_0 dq_v - q_v dq_0 + q_v x dq_v).) Conventions as in so3.h: d(Lambda) = hat(dvartheta)
/// Lambda with dvartheta = T(c) dc. (docs/notes/beam.md, sec. 1.4; Milenkovic 1982)

#include "math/cayley.h"

namespace flexarm::conformal {

namespace detail {
/// tan^2(theta / 4).
template <typename S>
inline S squared_tangent(const Vector3T<S>& c) {
  return S(0.0625) * so3::dot(c, c);
}

/// Returns the derivative with respect to c of T(c)^-1 a = (1 - x) a - c x a / 2 + (c.a) c / 8, for `sign` = 1. The
/// derivatives of T and T^T contain it, too, up to a factor and the sign of the skew part.
template <typename S>
inline Matrix3T<S> xi_polynomial(const Vector3T<S>& c, const S& sign, const Vector3T<S>& a) {
  // c a^T - a c^T = hat(a x c).
  Matrix3T<S> result = so3::hat(Vector3T<S>((S(0.5) * sign) * a + S(0.125) * so3::cross(a, c)));
  result.diagonal().array() += S(0.125) * so3::dot(c, a);
  return result;
}
}  // namespace detail

/// Lambda(c) = I + ((1 - x) hat(c) + hat(c)^2 / 2) / (1 + x)^2, x = c.c/16.
template <typename V>
inline Matrix3T<typename V::Scalar> rotation(const Eigen::MatrixBase<V>& c) {
  using S = typename V::Scalar;
  const Vector3T<S> t = c;
  const S x = detail::squared_tangent(t), g = S(1) / (S(1) + x);
  return so3::detail::identity_plus<S>(g * g * (S(1) - x), S(0.5) * g * g, t);
}

/// Unit quaternion (1 - x, c/2) / (1 + x), x = c.c/16; q0 < 0 for angles beyond pi.
template <typename V>
inline QuaternionT<typename V::Scalar> quaternion(const Eigen::MatrixBase<V>& c) {
  using S = typename V::Scalar;
  const S x = detail::squared_tangent(Vector3T<S>(c)), g = S(1) / (S(1) + x), half = S(0.5) * g;
  return QuaternionT<S>(g * (S(1) - x), half * c[0], half * c[1], half * c[2]);
}

/// Conformal vector, |c| <= 4, of a quaternion of any norm and sign; accurate from 0 through pi.
template <typename Q>
inline Vector3T<typename Q::Scalar> from_quaternion(const Eigen::QuaternionBase<Q>& quaternion) {
  using std::sqrt;
  using S = typename Q::Scalar;
  const S sign(std::real(quaternion.w()) < so3::RealOf<S>(0) ? -1 : 1);
  const Vector3T<S> q(quaternion.x(), quaternion.y(), quaternion.z());
  const S norm = sqrt(quaternion.w() * quaternion.w() + so3::dot(q, q));
  return (S(4) * sign / (norm + sign * quaternion.w())) * q;
}

/// c of a rotation vector theta, |theta| < 2 pi.
template <typename V>
inline Vector3T<typename V::Scalar> from_rotation_vector(const Eigen::MatrixBase<V>& theta) {
  using S = typename V::Scalar;
  return S(2) * cayley::from_rotation_vector(Vector3T<S>(S(0.5) * theta));
}

/// Rotation vector, |theta| < 2 pi, of c.
template <typename V>
inline Vector3T<typename V::Scalar> to_rotation_vector(const Eigen::MatrixBase<V>& c) {
  using S = typename V::Scalar;
  return so3::detail::arctangent_ratio<S>(detail::squared_tangent(Vector3T<S>(c))) * c;
}

/// The other vector of the same rotation, -16 c / |c|^2. Its angle is 2 pi - theta about the opposite axis, and its
/// quaternion has the opposite sign. Infinite for c = 0.
template <typename V>
inline Vector3T<typename V::Scalar> shadow(const Eigen::MatrixBase<V>& c) {
  using S = typename V::Scalar;
  return (S(-16) / so3::dot(c, c)) * c;
}

/// c21, |c21| <= 4, with Lambda(c21) = Lambda(c2) Lambda(c1). Regular for all c1, c2: from the product and its shadow,
/// the one with the larger denominator is computed.
template <typename V, typename U>
inline Vector3T<typename V::Scalar> compound(const Eigen::MatrixBase<V>& c2, const Eigen::MatrixBase<U>& c1) {
  using S = typename V::Scalar;
  const S x1 = detail::squared_tangent(Vector3T<S>(c1)), x2 = detail::squared_tangent(Vector3T<S>(c2));
  // Quaternion of the product times its norm (1 + x1) (1 + x2).
  const S norm = (S(1) + x1) * (S(1) + x2);
  const S q0 = (S(1) - x1) * (S(1) - x2) - S(0.25) * so3::dot(c1, c2);
  const Vector3T<S> twice_q = (S(1) - x1) * c2 + (S(1) - x2) * c1 + S(0.5) * so3::cross(c2, c1);
  const S sign(std::real(q0) < so3::RealOf<S>(0) ? -1 : 1);
  return (S(2) * sign / (norm + sign * q0)) * twice_q;
}

/// T(c) = (I + (hat(c)/2 + hat(c)^2/8) / (1 + x)) / (1 + x), x = c.c/16: spatial spin per change of c. T^T gives the
/// material spin.
template <typename V>
inline Matrix3T<typename V::Scalar> tangent(const Eigen::MatrixBase<V>& c) {
  using S = typename V::Scalar;
  const Vector3T<S> t = c;
  const S g = S(1) / (S(1) + detail::squared_tangent(t));
  return g * so3::detail::identity_plus<S>(S(0.5) * g, S(0.125) * g, t);
}

/// T(c)^-1 = (1 - x) I - hat(c)/2 + c c^T/8, x = c.c/16.
template <typename V>
inline Matrix3T<typename V::Scalar> inverse_tangent(const Eigen::MatrixBase<V>& c) {
  using S = typename V::Scalar;
  const Vector3T<S> t = c;
  Matrix3T<S> result = (S(0.125) * t) * t.transpose();
  result += so3::hat(Vector3T<S>(S(-0.5) * t));
  result.diagonal().array() += S(1) - detail::squared_tangent(t);
  return result;
}

/// (T^-1)' = d/ds T(c(s))^-1 for dc = d/ds c.
template <typename V, typename D>
inline Matrix3T<typename V::Scalar> inverse_tangent_derivative(const Eigen::MatrixBase<V>& c,
                                                               const Eigen::MatrixBase<D>& dc) {
  using S = typename V::Scalar;
  const Matrix3T<S> product = (S(0.125) * dc) * c.transpose();
  Matrix3T<S> result = product + product.transpose() - so3::hat(Vector3T<S>(S(0.5) * dc));
  result.diagonal().array() -= S(0.125) * so3::dot(c, dc);
  return result;
}

/// T' = d/ds T(c(s)) for dc = d/ds c. Computed by T = g^2 (T^-1)^T with g = 1 / (1 + x).
template <typename V, typename D>
inline Matrix3T<typename V::Scalar> tangent_derivative(const Eigen::MatrixBase<V>& c, const Eigen::MatrixBase<D>& dc) {
  using S = typename V::Scalar;
  const Vector3T<S> t = c;
  const S g = S(1) / (S(1) + detail::squared_tangent(t));
  return (g * g) * inverse_tangent_derivative(t, dc).transpose() - (S(0.25) * g * so3::dot(t, dc)) * tangent(t);
}

/// Xi with d(T(c) a) = Xi dc for constant a.
template <typename V, typename A>
inline Matrix3T<typename V::Scalar> xi_tangent(const Eigen::MatrixBase<V>& c, const Eigen::MatrixBase<A>& a) {
  using S = typename V::Scalar;
  const Vector3T<S> t = c;
  const S g = S(1) / (S(1) + detail::squared_tangent(t));
  const Vector3T<S> image = tangent(t) * a;
  return (g * g) * detail::xi_polynomial<S>(t, S(-1), a) - (S(0.25) * g * image) * t.transpose();
}

/// Xi with d(T(c)^T a) = Xi dc for constant a.
template <typename V, typename A>
inline Matrix3T<typename V::Scalar> xi_tangent_transposed(const Eigen::MatrixBase<V>& c,
                                                          const Eigen::MatrixBase<A>& a) {
  using S = typename V::Scalar;
  const Vector3T<S> t = c;
  const S g = S(1) / (S(1) + detail::squared_tangent(t));
  const Vector3T<S> image = tangent(t).transpose() * a;
  return (g * g) * detail::xi_polynomial<S>(t, S(1), a) - (S(0.25) * g * image) * t.transpose();
}

/// Xi with d(T(c)^-1 a) = Xi dc for constant a.
template <typename V, typename A>
inline Matrix3T<typename V::Scalar> xi_inverse_tangent(const Eigen::MatrixBase<V>& c, const Eigen::MatrixBase<A>& a) {
  using S = typename V::Scalar;
  return detail::xi_polynomial<S>(c, S(1), a);
}

}  // namespace flexarm::conformal
