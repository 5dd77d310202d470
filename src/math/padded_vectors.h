#pragma once
/// Vectors of three numbers, 3x3 matrices and spatial vectors, of which each column fills a register of four. Eigen's
/// products of 3x3 matrices use one number of a register. The fourth number is 0.

#include "flexarm/math/pose.h"
#include "math/lanes.h"

namespace flexarm {

/// {x, y, z, 0}.
struct Padded3 {
  Pack values;

  Padded3() = default;
  [[gnu::always_inline]] explicit Padded3(const Pack& numbers) : values(numbers) {}
  [[gnu::always_inline]] explicit Padded3(const Vector3& v) : values(v[0], v[1], v[2], 0) {}
  [[gnu::always_inline]] static Padded3 zero() { return Padded3(Pack(0)); }
  [[gnu::always_inline]] double operator[](int i) const { return values[i]; }
  [[gnu::always_inline]] Vector3 vector() const { return {values[0], values[1], values[2]}; }

  [[gnu::always_inline]] Padded3& operator+=(const Padded3& other) {
    values += other.values;
    return *this;
  }
  [[gnu::always_inline]] Padded3& operator-=(const Padded3& other) {
    values -= other.values;
    return *this;
  }
  [[gnu::always_inline]] friend Padded3 operator+(const Padded3& a, const Padded3& b) {
    return Padded3(a.values + b.values);
  }
  [[gnu::always_inline]] friend Padded3 operator-(const Padded3& a, const Padded3& b) {
    return Padded3(a.values - b.values);
  }
  [[gnu::always_inline]] friend Padded3 operator*(double a, const Padded3& b) { return Padded3(a * b.values); }
  /// Component i in all four places.
  template <int i>
  [[gnu::always_inline]] Pack spread() const {
    return shuffled<i, i, i, i>(values.values(), values.values());
  }
};

[[gnu::always_inline]] inline double sum(const Pack& v) {
  return v[0] + v[1] + v[2];
}

/// {y, z, x}.
[[gnu::always_inline]] inline Pack rotated(const Pack& v) {
  return shuffled<1, 2, 0, 3>(v.values(), v.values());
}

[[gnu::always_inline]] inline Padded3 cross(const Padded3& a, const Padded3& b) {
  return Padded3(rotated(a.values * rotated(b.values) - rotated(a.values) * b.values));
}

/// A 3x3 matrix, by columns.
struct PaddedMatrix3 {
  Padded3 columns[3];

  PaddedMatrix3() = default;
  explicit PaddedMatrix3(const Matrix3& matrix) {
    for (int j = 0; j < 3; ++j) columns[j] = Padded3(Vector3(matrix.col(j)));
  }
  [[gnu::always_inline]] PaddedMatrix3(const Padded3& x, const Padded3& y, const Padded3& z) : columns{x, y, z} {}
  [[gnu::always_inline]] static PaddedMatrix3 diagonal(double value) {
    return {Padded3(Pack(value, 0, 0, 0)), Padded3(Pack(0, value, 0, 0)), Padded3(Pack(0, 0, value, 0))};
  }
  Matrix3 matrix() const {
    Matrix3 out;
    for (int j = 0; j < 3; ++j) out.col(j) = columns[j].vector();
    return out;
  }

  [[gnu::always_inline]] PaddedMatrix3& operator+=(const PaddedMatrix3& other) {
    for (int j = 0; j < 3; ++j) columns[j] += other.columns[j];
    return *this;
  }
  [[gnu::always_inline]] friend PaddedMatrix3 operator+(const PaddedMatrix3& a, const PaddedMatrix3& b) {
    return {a.columns[0] + b.columns[0], a.columns[1] + b.columns[1], a.columns[2] + b.columns[2]};
  }
  [[gnu::always_inline]] friend PaddedMatrix3 operator-(const PaddedMatrix3& a, const PaddedMatrix3& b) {
    return {a.columns[0] - b.columns[0], a.columns[1] - b.columns[1], a.columns[2] - b.columns[2]};
  }
  [[gnu::always_inline]] friend PaddedMatrix3 operator*(double a, const PaddedMatrix3& b) {
    return {a * b.columns[0], a * b.columns[1], a * b.columns[2]};
  }
  [[gnu::always_inline]] friend Padded3 operator*(const PaddedMatrix3& a, const Padded3& b) {
    return Padded3(a.columns[0].values * b.spread<0>() + a.columns[1].values * b.spread<1>() +
                   a.columns[2].values * b.spread<2>());
  }
  [[gnu::always_inline]] friend PaddedMatrix3 operator*(const PaddedMatrix3& a, const PaddedMatrix3& b) {
    return {a * b.columns[0], a * b.columns[1], a * b.columns[2]};
  }
};

/// a b^T.
[[gnu::always_inline]] inline PaddedMatrix3 times_transposed(const PaddedMatrix3& a, const PaddedMatrix3& b) {
  const auto column = [&](const Pack& x, const Pack& y, const Pack& z) {
    return Padded3(a.columns[0].values * x + a.columns[1].values * y + a.columns[2].values * z);
  };
  const Padded3* c = b.columns;
  return {column(c[0].spread<0>(), c[1].spread<0>(), c[2].spread<0>()),
          column(c[0].spread<1>(), c[1].spread<1>(), c[2].spread<1>()),
          column(c[0].spread<2>(), c[1].spread<2>(), c[2].spread<2>())};
}

/// hat(v) matrix: the cross product of v and each column.
[[gnu::always_inline]] inline PaddedMatrix3 cross(const Padded3& v, const PaddedMatrix3& matrix) {
  return {cross(v, matrix.columns[0]), cross(v, matrix.columns[1]), cross(v, matrix.columns[2])};
}

/// matrix hat(v).
[[gnu::always_inline]] inline PaddedMatrix3 times_hat(const PaddedMatrix3& matrix, const Padded3& v) {
  const Padded3* c = matrix.columns;
  const Pack x = v.spread<0>(), y = v.spread<1>(), z = v.spread<2>();
  return {Padded3(z * c[1].values - y * c[2].values), Padded3(x * c[2].values - z * c[0].values),
          Padded3(y * c[0].values - x * c[1].values)};
}

/// {v, w} or {f, m}.
struct PaddedSpatial {
  Padded3 linear, angular;

  PaddedSpatial() = default;
  [[gnu::always_inline]] PaddedSpatial(const Padded3& first, const Padded3& second) : linear(first), angular(second) {}
  explicit PaddedSpatial(const Vector6& v) : linear(Vector3(v.head<3>())), angular(Vector3(v.tail<3>())) {}
  [[gnu::always_inline]] static PaddedSpatial zero() { return {Padded3::zero(), Padded3::zero()}; }
  Vector6 vector() const {
    Vector6 out;
    out << linear.vector(), angular.vector();
    return out;
  }

  [[gnu::always_inline]] PaddedSpatial& operator+=(const PaddedSpatial& other) {
    linear += other.linear, angular += other.angular;
    return *this;
  }
  [[gnu::always_inline]] PaddedSpatial& operator-=(const PaddedSpatial& other) {
    linear -= other.linear, angular -= other.angular;
    return *this;
  }
  [[gnu::always_inline]] friend PaddedSpatial operator+(const PaddedSpatial& a, const PaddedSpatial& b) {
    return {a.linear + b.linear, a.angular + b.angular};
  }
  [[gnu::always_inline]] friend PaddedSpatial operator*(double a, const PaddedSpatial& b) {
    return {a * b.linear, a * b.angular};
  }
};

/// {f, m} about another point, from which the present one is `way` away.
[[gnu::always_inline]] inline PaddedSpatial moved_force(const PaddedSpatial& force, const Padded3& way) {
  return {force.linear, force.angular + cross(way, force.linear)};
}

[[gnu::always_inline]] inline double dot(const PaddedSpatial& a, const PaddedSpatial& b) {
  return sum(a.linear.values * b.linear.values + a.angular.values * b.angular.values);
}

/// The symmetric map of {dv/dt, dw/dt} to {f, m}. Both blocks beside the diagonal are kept, so that nothing is
/// transposed.
struct PaddedInertia {
  PaddedMatrix3 linear, mixed, mixed_transposed, rotary;

  [[gnu::always_inline]] friend PaddedSpatial operator*(const PaddedInertia& a, const PaddedSpatial& b) {
    return {a.linear * b.linear + a.mixed * b.angular, a.mixed_transposed * b.linear + a.rotary * b.angular};
  }
  /// Subtracts a b^T, which must be symmetric together with all other such terms.
  [[gnu::always_inline]] void subtract_outer(const PaddedSpatial& a, const PaddedSpatial& b) {
    subtract<0>(a, b), subtract<1>(a, b), subtract<2>(a, b);
  }
  [[gnu::always_inline]] PaddedInertia& operator+=(const PaddedInertia& other) {
    linear += other.linear, mixed += other.mixed, mixed_transposed += other.mixed_transposed, rotary += other.rotary;
    return *this;
  }
  /// The inertia about a point from which the present one is `way` away.
  [[gnu::always_inline]] PaddedInertia moved(const Padded3& way) const {
    const PaddedMatrix3 there = mixed - times_hat(linear, way);
    // hat(way) there - mixed^T hat(way) moves the rotary block.
    return {linear, there, mixed_transposed + cross(way, linear),
            rotary + cross(way, there) - times_hat(mixed_transposed, way)};
  }

 private:
  template <int j>
  [[gnu::always_inline]] void subtract(const PaddedSpatial& a, const PaddedSpatial& b) {
    const Pack of_linear = b.linear.spread<j>(), of_angular = b.angular.spread<j>();
    linear.columns[j].values -= a.linear.values * of_linear;
    mixed.columns[j].values -= a.linear.values * of_angular;
    mixed_transposed.columns[j].values -= a.angular.values * of_linear;
    rotary.columns[j].values -= a.angular.values * of_angular;
  }
};

}  // namespace flexarm
