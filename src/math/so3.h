#pragma once
/// Finite rotations by rotation vectors: exponential, logarithm, tangent operators and their derivatives.
///
/// Conventions: spatial spin, d(exp theta) = hat(dvartheta) exp theta with dvartheta = T(theta) dtheta. Angles in rad.
/// Everything is a template on the scalar type, so that tests can use long double and complex steps. Therefore products
/// are bilinear (without conjugation), and branches depend on real parts only. The functions that elements call also
/// work for a Pack. Nothing allocates or throws; non-finite input gives non-finite output. (Muñoz 2004, eq. 2.14-2.21)

#include <Eigen/Geometry>

#include "math/rotation_series.h"

namespace flexarm {

template <typename S>
using Vector3T = Eigen::Matrix<S, 3, 1>;
template <typename S>
using Matrix3T = Eigen::Matrix<S, 3, 3>;
template <typename S>
using QuaternionT = Eigen::Quaternion<S>;

namespace so3 {

/// a . b without conjugation (Eigen's dot() conjugates, which breaks complex steps).
template <typename A, typename B>
inline typename A::Scalar dot(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// a x b without conjugation.
template <typename A, typename B>
inline Vector3T<typename A::Scalar> cross(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Skew-symmetric matrix of a vector: hat(v) a = v x a.
template <typename V>
inline Matrix3T<typename V::Scalar> hat(const Eigen::MatrixBase<V>& v) {
  using S = typename V::Scalar;
  Matrix3T<S> result;
  result << S(0), -v[2], v[1], v[2], S(0), -v[0], -v[1], v[0], S(0);
  return result;
}

/// Axial vector of the skew-symmetric part of a matrix: vee(hat(v)) = v.
template <typename M>
inline Vector3T<typename M::Scalar> vee(const Eigen::MatrixBase<M>& m) {
  const RealOf<typename M::Scalar> half(0.5);
  return {half * (m(2, 1) - m(1, 2)), half * (m(0, 2) - m(2, 0)), half * (m(1, 0) - m(0, 1))};
}

namespace detail {

/// I + c1 hat(v) + c2 hat(v)^2.
template <typename S>
[[gnu::always_inline]] inline Matrix3T<S> identity_plus(const S& c1, const S& c2, const Vector3T<S>& v) {
  const S xx = v[0] * v[0], yy = v[1] * v[1], zz = v[2] * v[2];
  const S xy = c2 * v[0] * v[1], xz = c2 * v[0] * v[2], yz = c2 * v[1] * v[2];
  const S x = c1 * v[0], y = c1 * v[1], z = c1 * v[2];
  const S one(1);
  Matrix3T<S> result;
  result << one - c2 * (yy + zz), xy - z, xz + y, xy + z, one - c2 * (xx + zz), yz - x, xz - y, yz + x,
      one - c2 * (xx + yy);
  return result;
}

/// hat(w) + c (hat(d) hat(v) + hat(v) hat(d)) + e hat(v)^2. All derivatives of identity_plus() have this form.
template <typename S>
[[gnu::always_inline]] inline Matrix3T<S> identity_plus_derivative(const Vector3T<S>& w, const S& c, const S& e,
                                                                   const Vector3T<S>& v, const Vector3T<S>& d) {
  // hat(a) hat(v) + hat(v) hat(a) = a v^T + v a^T - 2 (a.v) I, and hat(v)^2 is half of this for a = v. So both terms
  // together have this form with one vector a = u.
  const Vector3T<S> u = c * d + (S(0.5) * e) * v;
  Matrix3T<S> result = u * v.transpose();
  result += Matrix3T<S>(result.transpose());
  result.diagonal().array() -= S(2) * dot(u, v);
  result += hat(w);
  return result;
}

}  // namespace detail

/// All operators of one rotation vector theta, from a single evaluation of the coefficients. Use one object if several
/// of exp, T, T^-1 and their derivatives are needed at the same theta.
/// @note T is singular at |theta| = 2 pi; T^-1 and its derivatives need |theta| < 2 pi.
template <typename S>
class ExponentialMap {
 public:
  using Vector = Vector3T<S>;
  using Matrix = Matrix3T<S>;

  template <typename V>
  [[gnu::always_inline]] inline explicit ExponentialMap(const Eigen::MatrixBase<V>& theta)
      : theta_(theta), a_(series_coefficients<5>(dot(theta_, theta_))) {}

  const Vector& rotation_vector() const { return theta_; }

  /// exp theta = I + a_0 hat(theta) + a_1 hat(theta)^2.
  Matrix rotation() const { return detail::identity_plus<S>(a_[0], a_[1], theta_); }

  /// T(theta) = I + a_1 hat(theta) + a_2 hat(theta)^2: spatial spin per change of theta; T^T gives the material spin.
  Matrix tangent() const { return detail::identity_plus<S>(a_[1], a_[2], theta_); }

  /// T(theta)^-1 = I - 1/2 hat(theta) + b hat(theta)^2.
  Matrix inverse_tangent() const { return detail::identity_plus<S>(S(-0.5), b(), theta_); }

  /// T(theta)^T v without forming T: material spin (or curvature) of a change (or derivative) v of theta.
  Vector material_spin(const Vector& v) const {
    const Vector once = cross(theta_, v);
    return v - a_[1] * once + a_[2] * cross(theta_, once);
  }

  /// T' = d/ds T(theta(s)) for dtheta = d/ds theta.
  Matrix tangent_derivative(const Vector& dtheta) const {
    const S p = dot(theta_, dtheta);
    return detail::identity_plus_derivative<S>(a_[1] * dtheta + (p * rate<1>()) * theta_, a_[2], p * rate<2>(), theta_,
                                               dtheta);
  }

  /// (T^-1)' = d/ds T(theta(s))^-1.
  Matrix inverse_tangent_derivative(const Vector& dtheta) const {
    const S p = dot(theta_, dtheta);
    return detail::identity_plus_derivative<S>(S(-0.5) * dtheta, b(), p * b_rate(), theta_, dtheta);
  }

  /// Xi with d(T(theta) a) = Xi dtheta for constant a.
  Matrix xi_tangent(const Vector& a) const { return xi(a, -a_[1], rate<1>(), a_[2], rate<2>()); }

  /// Xi with d(T(theta)^T a) = Xi dtheta for constant a.
  Matrix xi_tangent_transposed(const Vector& a) const { return xi(a, a_[1], -rate<1>(), a_[2], rate<2>()); }

  /// Xi with d(T(theta)^-1 a) = Xi dtheta for constant a.
  Matrix xi_inverse_tangent(const Vector& a) const { return xi(a, S(0.5), S(0), b(), b_rate()); }

 private:
  /// (1/theta) d(a_k)/d(theta).
  template <int k>
  S rate() const {
    return S(k + 1) * a_[k + 2] - a_[k + 1];
  }
  S b() const { return (a_[2] - S(2) * a_[3]) / (S(2) * a_[1]); }
  /// (1/theta) db/d(theta).
  S b_rate() const {
    const S value = b();
    return (rate<2>() - S(2) * rate<3>()) / (S(2) * a_[1]) + S(2) * value * value;
  }
  /// c0 hat(a) + c1 (hat(theta) a) theta^T - c2 (hat(hat(theta) a) + hat(theta) hat(a)) + c3 (hat(theta)^2 a) theta^T.
  Matrix xi(const Vector& a, const S& c0, const S& c1, const S& c2, const S& c3) const {
    const Vector once = cross(theta_, a);
    const Vector twice = cross(theta_, once);
    Matrix result = (c1 * once + c3 * twice) * theta_.transpose();
    result -= (c2 * a) * theta_.transpose();  // hat(theta) hat(a) = a theta^T - theta.a I
    result.diagonal().array() += c2 * dot(theta_, a);
    result += hat(Vector(c0 * a - c2 * once));
    return result;
  }

  Vector theta_;
  std::array<S, 6> a_;
};

template <typename V>
ExponentialMap(const Eigen::MatrixBase<V>&) -> ExponentialMap<typename V::Scalar>;

/// Rotation matrix of a rotation vector, any |theta|.
template <typename V>
inline Matrix3T<typename V::Scalar> exp(const Eigen::MatrixBase<V>& theta) {
  return ExponentialMap<typename V::Scalar>(theta).rotation();
}

/// Unit quaternion (cos(theta/2), sin(theta/2) theta/|theta|) of a rotation vector; q0 >= 0 only for |theta| <= pi.
template <typename V>
inline QuaternionT<typename V::Scalar> exp_quaternion(const Eigen::MatrixBase<V>& theta) {
  using S = typename V::Scalar;
  const Vector3T<S> half = S(0.5) * theta;
  const S x = dot(half, half);
  const std::array<S, 2> a = series_coefficients<1>(x);
  return QuaternionT<S>(S(1) - x * a[1], a[0] * half[0], a[0] * half[1], a[0] * half[2]);
}

/// Unit quaternion with q0 >= 0 of a rotation matrix, by Spurrier's algorithm, which chooses the largest pivot.
template <typename M>
inline QuaternionT<typename M::Scalar> quaternion_from_matrix(const Eigen::MatrixBase<M>& rotation) {
  using std::sqrt;
  using S = typename M::Scalar;
  using Real = RealOf<S>;
  const Matrix3T<S> r = rotation;
  const S trace = r(0, 0) + r(1, 1) + r(2, 2);
  int i = 0;
  if (std::real(r(1, 1)) > std::real(r(0, 0))) i = 1;
  if (std::real(r(2, 2)) > std::real(r(i, i))) i = 2;
  S q0;
  Vector3T<S> q;
  if (std::real(trace) >= std::real(r(i, i))) {
    q0 = Real(0.5) * sqrt(S(1) + trace);
    q = vee(r) / (S(2) * q0);
  } else {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    q[i] = sqrt(Real(0.5) * r(i, i) + Real(0.25) * (S(1) - trace));
    const S scale = Real(0.25) / q[i];
    q0 = scale * (r(k, j) - r(j, k));
    q[j] = scale * (r(j, i) + r(i, j));
    q[k] = scale * (r(k, i) + r(i, k));
  }
  const Real sign(std::real(q0) < Real(0) ? -1 : 1);
  return QuaternionT<S>(sign * q0, sign * q[0], sign * q[1], sign * q[2]);
}

/// Returns q or -q, which are the same rotation: the one whose rotation relative to `other` is less than pi.
template <typename S>
inline QuaternionT<S> nearer_of_two(const QuaternionT<S>& q, const QuaternionT<S>& other) {
  const auto sign = sign_of(q.w() * other.w() + q.x() * other.x() + q.y() * other.y() + q.z() * other.z());
  return QuaternionT<S>(sign * q.w(), sign * q.x(), sign * q.y(), sign * q.z());
}

/// Rotation vector, |theta| <= pi, of a quaternion; accurate from 0 to pi. q and -q give the same result (up to the
/// sign of theta at exactly pi), and so does any multiple of q, so normalisation errors do not matter.
template <typename Q>
inline Vector3T<typename Q::Scalar> log(const Eigen::QuaternionBase<Q>& quaternion) {
  using S = typename Q::Scalar;
  const auto sign = sign_of(quaternion.w());
  const S q0 = sign * quaternion.w();
  const Vector3T<S> q(sign * quaternion.x(), sign * quaternion.y(), sign * quaternion.z());
  const S square = dot(q, q);
  return detail::angle_per_sine(q0, square) * q;
}

/// Rotation vector, |theta| < 2 pi, of a quaternion, by continuation from the identity: |theta| > pi if q0 < 0.
/// Positive multiples of the quaternion give the same result.
template <typename Q>
inline Vector3T<typename Q::Scalar> unfolded_log(const Eigen::QuaternionBase<Q>& quaternion) {
  using S = typename Q::Scalar;
  const Vector3T<S> q(quaternion.x(), quaternion.y(), quaternion.z());
  return detail::angle_per_sine(S(quaternion.w()), S(dot(q, q))) * q;
}

/// Rotation vector, |theta| <= pi, of a rotation matrix; accurate from 0 to pi.
template <typename M>
inline Vector3T<typename M::Scalar> log(const Eigen::MatrixBase<M>& rotation) {
  return so3::log(quaternion_from_matrix(rotation));
}

/// Rotation vector theta21, |theta21| <= pi, with exp theta21 = exp theta2 exp theta1.
template <typename V, typename U>
inline Vector3T<typename V::Scalar> compound(const Eigen::MatrixBase<V>& theta2, const Eigen::MatrixBase<U>& theta1) {
  return so3::log(exp_quaternion(theta2) * exp_quaternion(theta1));
}

/// Single operators; see the members of ExponentialMap of the same name.
template <typename V>
inline Matrix3T<typename V::Scalar> tangent(const Eigen::MatrixBase<V>& theta) {
  return ExponentialMap<typename V::Scalar>(theta).tangent();
}
template <typename V>
inline Matrix3T<typename V::Scalar> inverse_tangent(const Eigen::MatrixBase<V>& theta) {
  return ExponentialMap<typename V::Scalar>(theta).inverse_tangent();
}
template <typename V, typename D>
inline Matrix3T<typename V::Scalar> tangent_derivative(const Eigen::MatrixBase<V>& theta,
                                                       const Eigen::MatrixBase<D>& dtheta) {
  return ExponentialMap<typename V::Scalar>(theta).tangent_derivative(dtheta);
}
template <typename V, typename D>
inline Matrix3T<typename V::Scalar> inverse_tangent_derivative(const Eigen::MatrixBase<V>& theta,
                                                               const Eigen::MatrixBase<D>& dtheta) {
  return ExponentialMap<typename V::Scalar>(theta).inverse_tangent_derivative(dtheta);
}
template <typename V, typename A>
inline Matrix3T<typename V::Scalar> xi_tangent(const Eigen::MatrixBase<V>& theta, const Eigen::MatrixBase<A>& a) {
  return ExponentialMap<typename V::Scalar>(theta).xi_tangent(a);
}
template <typename V, typename A>
inline Matrix3T<typename V::Scalar> xi_tangent_transposed(const Eigen::MatrixBase<V>& theta,
                                                          const Eigen::MatrixBase<A>& a) {
  return ExponentialMap<typename V::Scalar>(theta).xi_tangent_transposed(a);
}
template <typename V, typename A>
inline Matrix3T<typename V::Scalar> xi_inverse_tangent(const Eigen::MatrixBase<V>& theta,
                                                       const Eigen::MatrixBase<A>& a) {
  return ExponentialMap<typename V::Scalar>(theta).xi_inverse_tangent(a);
}

/// Symmetric Hessian with respect to theta of M . (T(theta)^T dtheta), M and dtheta constant.
template <typename V>
inline Matrix3T<typename V::Scalar> xi_second_tangent(const Eigen::MatrixBase<V>& theta,
                                                      const Vector3T<typename V::Scalar>& m,
                                                      const Vector3T<typename V::Scalar>& dtheta) {
  using S = typename V::Scalar;
  using Vector = Vector3T<S>;
  const Vector t = theta;
  const S x = dot(t, t);
  const std::array<S, 7> a = series_coefficients<6>(x);
  std::array<S, 5> rate;  // a_k^* = (1/theta) d(a_k)/d(theta)
  for (int k = 0; k < 5; ++k) rate[k] = S(k + 1) * a[k + 2] - a[k + 1];
  const S rate1_rate = S(2) * rate[3] - rate[2], rate2_rate = S(3) * rate[4] - rate[3];
  // The function is m.dtheta + a_1 p + a_2 q, with polynomials p and q of theta, whose gradients are w and grad_q.
  const Vector w = cross(m, dtheta);
  const S p = dot(t, w);
  const S md = dot(m, dtheta), td = dot(t, dtheta), tm = dot(t, m);
  const S q = td * tm - x * md;
  const Vector grad_q = tm * dtheta + td * m - (S(2) * md) * t;
  const Vector along = (S(0.5) * (rate1_rate * p + rate2_rate * q)) * t + rate[1] * w + rate[2] * grad_q;
  Matrix3T<S> half = t * along.transpose() + (a[2] * dtheta) * m.transpose();
  half.diagonal().array() += S(0.5) * (rate[1] * p + rate[2] * q) - a[2] * md;
  return half + half.transpose();
}

}  // namespace so3
}  // namespace flexarm
