#pragma once
/// Scalar functions of an angle for finite rotations, such as sin(theta)/theta, without 0/0. They are templates on the
/// scalar type. For a Pack, lanes with large angles, which are rare, are computed one by one.

#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include "math/pack.h"

namespace flexarm::so3 {

template <typename S>
using RealOf = typename Eigen::NumTraits<S>::Real;

namespace detail {

/// 1 / n!, n <= 40.
inline constexpr std::array<long double, 41> reciprocal_factorials = [] {
  std::array<long double, 41> table{};
  long double factorial = 1;
  for (int n = 0; n <= 40; ++n) {
    factorial *= n > 0 ? n : 1;
    table[n] = 1 / factorial;
  }
  return table;
}();

template <typename S>
inline constexpr int extra_terms = std::numeric_limits<RealOf<S>>::digits > 53 ? 2 : 0;

/// Returns sum_i c_i x^i by Estrin's scheme: pairs of terms, then pairs of pairs in x^2, and so on. In Horner's scheme,
/// each operation waits for the previous one, which takes two to three times as long.
template <std::size_t terms, typename C, typename S>
[[gnu::always_inline]] inline S polynomial(const std::array<C, terms>& c, const S& x) {
  if constexpr (terms == 1) {
    return S(c[0]);
  } else {
    std::array<S, (terms + 1) / 2> pairs;
#pragma GCC unroll 16
    for (std::size_t i = 0; i < terms / 2; ++i) pairs[i] = c[2 * i] + x * c[2 * i + 1];
    if constexpr (terms % 2 == 1) pairs[terms / 2] = S(c[terms - 1]);
    return polynomial(pairs, S(x * x));
  }
}

/// Returns a_k, see series_coefficients(), by its power series in x = theta^2.
template <int k, int terms, typename S>
[[gnu::always_inline]] inline S power_series(const S& x) {
  using Real = RealOf<S>;
  constexpr std::array<Real, terms> coefficients = [] {
    std::array<Real, terms> c{};
    for (int j = 0; j < terms; ++j) c[j] = static_cast<Real>((j % 2 ? -1 : 1) * reciprocal_factorials[2 * j + k + 1]);
    return c;
  }();
  return polynomial(coefficients, x);
}

/// arctan(sqrt(x)) / sqrt(x), to round-off for 0 <= x < arctangent_series_limit.
inline constexpr double arctangent_series_limit = 0.0625;
template <typename S>
[[gnu::always_inline]] inline S arctangent_series(const S& x) {
  using Real = RealOf<S>;
  constexpr int terms = 13 + 2 * extra_terms<S>;
  constexpr std::array<Real, terms> coefficients = [] {
    std::array<Real, terms> c{};
    for (int j = 0; j < terms; ++j) c[j] = Real(j % 2 ? -1 : 1) / Real(2 * j + 1);
    return c;
  }();
  return polynomial(coefficients, x);
}

/// arctan(sqrt(x)) / sqrt(x) for x >= 0. For small x uses a series, which is faster and has no 0/0.
template <typename S>
[[gnu::always_inline]] inline S arctangent_ratio(const S& x) {
  using std::atan;
  using std::sqrt;
  if (std::real(x) < RealOf<S>(arctangent_series_limit)) return arctangent_series(x);
  const S root = sqrt(x);
  return atan(root) / root;
}

/// theta / sin(theta/2), 0 <= theta < 2 pi, for a quaternion of any norm with q0 = cos(theta/2) and |q|^2 =
/// sin^2(theta/2).
template <typename S>
[[gnu::always_inline]] inline S angle_per_sine(const S& q0, const S& square) {
  using std::atan;
  using std::sqrt;
  using Real = RealOf<S>;
  if (std::real(q0) > Real(0) && std::real(square) < Real(3) * std::real(q0) * std::real(q0))  // theta < 2 pi / 3
    return Real(2) * arctangent_ratio<S>(square / (q0 * q0)) / q0;
  constexpr Real pi(3.141592653589793238462643383279502884L);
  const S sine = sqrt(square);
  return (pi - Real(2) * atan(q0 / sine)) / sine;
}

/// angle_per_sine() for single lanes of a pack with large angles. Not inlined, since it is rarely called.
[[gnu::noinline, gnu::cold]] inline double far_angle_per_sine(double q0, double square) {
  return angle_per_sine(q0, square);
}
[[gnu::always_inline]] inline Pack angle_per_sine(const Pack& q0, const Pack& square) {
  const Pack q00 = q0 * q0;
  Pack result = Pack(2) * arctangent_series(Pack(square / q00)) / q0;
  for_lanes_beyond(square, arctangent_series_limit * q0 * abs(q0),  // negative where theta > pi
                   [&](int lane) { result.set(lane, far_angle_per_sine(q0[lane], square[lane])); });
  return result;
}

template <int kmax>
std::array<double, kmax + 1> far_series_coefficients(double theta_squared);

}  // namespace detail

/// The coefficients a_0 to a_kmax, where a_k(theta) = sum_j (-1)^j theta^(2j) / (2j+k+1)!. Thus a_0 = sin(theta)/theta,
/// a_1 = (1-cos(theta))/theta^2 and a_2 = (theta-sin(theta))/theta^3. They are right to round-off for 0 <= theta^2 <=
/// (2 pi)^2. Below theta = 2, power series give the two highest, and the others follow by the recurrence
/// `a_{k-2} = 1/(k-1)! - theta^2 a_k`, which damps errors in this direction. Above, closed forms give a_0 and a_1, and
/// the recurrence is stable in the other direction. Closed forms in the half angle keep a_1 accurate at 2 pi.
/// @note 1 / theta d(a_k)/d(theta) = (k+1) a_{k+2} - a_{k+1}.
template <int kmax, typename S>
[[gnu::always_inline]] inline std::array<S, kmax + 1> series_coefficients(const S& theta_squared) {
  static_assert(kmax >= 1 && kmax <= 8, "the recurrences start from two coefficients");
  using std::cos;
  using std::sin;
  using std::sqrt;
  using Real = RealOf<S>;
  const S& x = theta_squared;
  std::array<S, kmax + 1> a;
  const auto fill_downwards = [&] {
#pragma GCC unroll 8
    for (int k = kmax; k >= 2; --k) a[k - 2] = static_cast<Real>(detail::reciprocal_factorials[k - 1]) - x * a[k];
  };
  if constexpr (is_pack<S>) {
    a[kmax] = detail::power_series<kmax, 9>(x);
    a[kmax - 1] = detail::power_series<kmax - 1, 9>(x);
    fill_downwards();
    for_lanes_beyond(x, S(1), [&](int lane) {
      const std::array<double, kmax + 1> b = detail::far_series_coefficients<kmax>(x[lane]);
      for (int k = 0; k <= kmax; ++k) a[k].set(lane, b[k]);
    });
  } else if (std::real(x) < Real(4)) {
    constexpr int extra = detail::extra_terms<S>;
    if (std::real(x) < Real(1)) {
      a[kmax] = detail::power_series<kmax, 9 + extra>(x);
      a[kmax - 1] = detail::power_series<kmax - 1, 9 + extra>(x);
    } else {
      a[kmax] = detail::power_series<kmax, 12 + extra>(x);
      a[kmax - 1] = detail::power_series<kmax - 1, 12 + extra>(x);
    }
    fill_downwards();
  } else {
    const S theta = sqrt(x);
    const S sine = sin(Real(0.5) * theta), cosine = cos(Real(0.5) * theta);
    a[0] = Real(2) * sine * cosine / theta;
    a[1] = Real(2) * sine * sine / x;
#pragma GCC unroll 8
    for (int k = 2; k <= kmax; ++k) a[k] = (static_cast<Real>(detail::reciprocal_factorials[k - 1]) - a[k - 2]) / x;
  }
  return a;
}

/// series_coefficients() for single lanes of a pack with large angles. Not inlined, since it is rarely called.
template <int kmax>
[[gnu::noinline, gnu::cold]] std::array<double, kmax + 1> detail::far_series_coefficients(double theta_squared) {
  return series_coefficients<kmax>(theta_squared);
}

}  // namespace flexarm::so3
