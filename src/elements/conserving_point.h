#pragma once
/// A stiffness point in the energy-momentum family: strains over a step, nodal forces of its stress resultants, and
/// their linearisation, by 3 x 3 blocks in world axes. (beam.md 3.2, beyond.md 1.3)

#include "elements/beam_point.h"
#include "elements/conserving_element.h"
#include "math/so3.h"

namespace flexarm::conserving {

/// m hat(v).
template <typename S>
Matrix3T<S> times_hat(const Matrix3T<S>& m, const Vector3T<S>& v) {
  Matrix3T<S> product;
  product.col(0) = m.col(1) * v[2] - m.col(2) * v[1];
  product.col(1) = m.col(2) * v[0] - m.col(0) * v[2];
  product.col(2) = m.col(0) * v[1] - m.col(1) * v[0];
  return product;
}

/// hat(v) m.
template <typename S>
Matrix3T<S> hat_times(const Vector3T<S>& v, const Matrix3T<S>& m) {
  Matrix3T<S> product;
  for (int j = 0; j < 3; ++j) product.col(j) = so3::cross(v, m.col(j));
  return product;
}

/// Strains and elastic stresses of a stiffness point over a step.
template <typename S>
struct PointStress {
  Vector6T<S> strain, stress;                      // means of both ends
  Vector6T<S> conjugate_strain, conjugate_stress;  // s and C s

  PointStress() = default;
  PointStress(const SectionStiffness<S>& stiffness, const Vector6T<S>& begin, const Vector6T<S>& end,
              const Vector6T<S>& conjugate)
      : strain(S(0.5) * (begin + end)),
        stress(stiffness.stress(strain)),
        conjugate_strain(conjugate),
        conjugate_stress(stiffness.stress(conjugate)) {}
};

/// A stiffness point over a step.
template <int Nodes, typename S>
struct Point {
  GeneralisedShapeFunctions<Nodes, S> generalised;  // at the end
  Matrix3T<S> end_rotation, average_rotation;       // Lambda_{n+1}, (Lambda_n + Lambda_{n+1}) / 2
  Vector3T<S> end_tangent, arm;                     // r'_{n+1}, (r'_n + r'_{n+1}) / 2
  Vector3T<S> increment, increment_derivative;      // interpolated w and w'
  Vector3T<S> stretch;                              // x = Delta r' + arm x w
  PointStress<S> own, seen;                         // of the trial configuration, and of what is carried
  Vector6T<S> half_defect_stress;                   // C (Delta Sigma - s) / 2
};

/// The averages of begin and end, and the conjugate strain s. `mid`: generalised shape functions at about the middle.
template <int Nodes, typename S>
void set_strains(const GeneralisedShapeFunctions<Nodes, S>& mid, const SectionStiffness<S>& stiffness,
                 const BeamNodes<Nodes, S>& nodes, const PointKinematicsT<S>& begin, const PointKinematicsT<S>& end,
                 Point<Nodes, S>& p) {
  p.end_rotation = end.rotation;
  p.end_tangent = end.tangent;
  p.average_rotation = S(0.5) * (begin.rotation + end.rotation);
  p.arm = S(0.5) * (begin.tangent + end.tangent);
  p.increment = mid.values[0] * nodes.increment[0];
  p.increment_derivative = mid.derivatives[0] * nodes.increment[0];
  for (int i = 1; i < Nodes; ++i) {
    p.increment += mid.values[i] * nodes.increment[i];
    p.increment_derivative += mid.derivatives[i] * nodes.increment[i];
  }
  p.stretch = end.tangent - begin.tangent + so3::cross(p.arm, p.increment);
  Vector6T<S> conjugate;
  conjugate.template head<3>() = p.average_rotation.transpose() * p.stretch;
  conjugate.template tail<3>() = p.average_rotation.transpose() * p.increment_derivative;
  p.own = PointStress<S>(stiffness, begin.strain, end.strain, conjugate);
}

/// A variation {dr', spin, spin', dw, dw'} of a point.
template <typename S>
struct PointVariation {
  Vector3T<S> position, spin, spin_derivative, increment, increment_derivative;
};

/// A linear form of it.
template <typename S>
struct PointForm {
  Vector3T<S> position, spin, spin_derivative, increment, increment_derivative;
};

template <typename S>
S value_of(const PointForm<S>& form, const PointVariation<S>& v) {
  return so3::dot(form.position, v.position) + so3::dot(form.spin, v.spin) +
         so3::dot(form.spin_derivative, v.spin_derivative) + so3::dot(form.increment, v.increment) +
         so3::dot(form.increment_derivative, v.increment_derivative);
}

/// What a variation makes of the strain at the end and of the conjugate strain s.
template <typename S>
struct StrainSlopes {
  Vector6T<S> end, conjugate;
};

template <int Nodes, typename S>
StrainSlopes<S> strain_slopes(const Point<Nodes, S>& p, const PointVariation<S>& v) {
  const Matrix3T<S> end = p.end_rotation.transpose(), average = p.average_rotation.transpose();
  StrainSlopes<S> slopes;
  slopes.end.template head<3>() = end * Vector3T<S>(v.position + so3::cross(p.end_tangent, v.spin));
  slopes.end.template tail<3>() = end * v.spin_derivative;
  const Vector3T<S> stretch =
      v.position + S(0.5) * so3::cross(v.position, p.increment) + so3::cross(p.arm, v.increment);
  slopes.conjugate.template head<3>() = average * stretch + end * Vector3T<S>(S(0.5) * so3::cross(p.stretch, v.spin));
  slopes.conjugate.template tail<3>() =
      average * v.increment_derivative + end * Vector3T<S>(S(0.5) * so3::cross(p.increment_derivative, v.spin));
  return slopes;
}

/// sum_i functions_i values_i.
template <int Nodes, typename S>
Vector3T<S> sum_of(const std::array<Matrix3T<S>, Nodes>& functions, const std::array<Vector3T<S>, Nodes>& values) {
  Vector3T<S> sum = functions[0] * values[0];
  for (int i = 1; i < Nodes; ++i) sum += functions[i] * values[i];
  return sum;
}

/// The form `conjugate`.ds + `end`.d(strain at the end) (beyond.md 1.3).
template <int Nodes, typename S>
PointForm<S> strain_form(const Point<Nodes, S>& p, const Vector6T<S>& conjugate, const Vector6T<S>& end) {
  const Matrix3T<S>& average = p.average_rotation;
  const Matrix3T<S>& rotation = p.end_rotation;
  const Vector3T<S> force = average * conjugate.template head<3>(), moment = average * conjugate.template tail<3>();
  const Vector3T<S> half_force = S(0.5) * (rotation * conjugate.template head<3>()),
                    half_moment = S(0.5) * (rotation * conjugate.template tail<3>());
  const Vector3T<S> end_force = rotation * end.template head<3>();
  PointForm<S> form;
  form.position = end_force + force - S(0.5) * so3::cross(force, p.increment);
  form.spin = so3::cross(end_force, p.end_tangent) + so3::cross(half_force, p.stretch) +
              so3::cross(half_moment, p.increment_derivative);
  form.spin_derivative = rotation * end.template tail<3>();
  form.increment = so3::cross(force, p.arm);
  form.increment_derivative = moment;
  return form;
}

/// Adds a form of a point as a row of the nodes' {dr, spin}.
template <int Nodes, typename S>
void add_form(const PointForm<S>& form, const NodalValues<Nodes, S>& derivative,
              const GeneralisedShapeFunctions<Nodes, S>& generalised, const GeneralisedShapeFunctions<Nodes, S>& mid,
              const std::array<Matrix3T<S>, Nodes>& inverse_tangent, std::array<Vector6T<S>, Nodes>& row) {
  for (int j = 0; j < Nodes; ++j) {
    row[j].template head<3>() += derivative[j] * form.position;
    const Vector3T<S> increment =
        mid.values[j].transpose() * form.increment + mid.derivatives[j].transpose() * form.increment_derivative;
    row[j].template tail<3>() += generalised.values[j].transpose() * form.spin;
    row[j].template tail<3>() += generalised.derivatives[j].transpose() * form.spin_derivative;
    row[j].template tail<3>() += inverse_tangent[j].transpose() * increment;
  }
}

/// Slopes of a stress resultant with respect to a point's {dr', spin, spin', dw, dw'}, in world axes.
template <typename S>
struct ResultantSlopes {
  Matrix3T<S> position, spin, spin_derivative, increment, increment_derivative;
};

/// The contributions of stiffness blocks to the slopes of weight Lambda_bar (C (d(strain at the end) / 2 + factor ds)).
template <int Nodes, typename S>
struct SlopeBuilder {
  const Point<Nodes, S>& p;
  Matrix3T<S> weighted_average;
  Vector3T<S> spin_strain, spin_curvature;  // r'_{n+1} + factor x, factor w'
  S factor;

  SlopeBuilder(const Point<Nodes, S>& p, const S& weight, const S& factor)
      : p(p),
        weighted_average(weight * p.average_rotation),
        spin_strain(p.end_tangent + factor * p.stretch),
        spin_curvature(factor * p.increment_derivative),
        factor(factor) {}

  /// Of a stiffness that strains Gamma act on. Sets all that Gamma depends on, or adds to the spin.
  void set_strain_part(const Matrix3T<S>& stiffness, bool adds, ResultantSlopes<S>& slopes) const {
    const Matrix3T<S> map = weighted_average.lazyProduct(stiffness);
    const Matrix3T<S> end = S(0.5) * map.lazyProduct(p.end_rotation.transpose());
    const Matrix3T<S> conjugate = factor * map.lazyProduct(p.average_rotation.transpose());
    slopes.position = end + conjugate - times_hat<S>(conjugate, S(0.5) * p.increment);
    slopes.increment = times_hat<S>(conjugate, p.arm);
    set(times_hat<S>(end, spin_strain), adds, slopes.spin);
  }
  /// Of one that curvatures K act on.
  void set_curvature_part(const Matrix3T<S>& stiffness, bool adds, ResultantSlopes<S>& slopes) const {
    const Matrix3T<S> map = weighted_average.lazyProduct(stiffness);
    slopes.spin_derivative = S(0.5) * map.lazyProduct(p.end_rotation.transpose());
    slopes.increment_derivative = factor * map.lazyProduct(p.average_rotation.transpose());
    set(times_hat<S>(slopes.spin_derivative, spin_curvature), adds, slopes.spin);
  }
  /// Adds those of factor ds alone. Of a stiffness that Gamma act on.
  void add_conjugate_strain_part(const Matrix3T<S>& stiffness, ResultantSlopes<S>& slopes) const {
    const Matrix3T<S> map = factor * weighted_average.lazyProduct(stiffness);
    const Matrix3T<S> conjugate = map.lazyProduct(p.average_rotation.transpose());
    slopes.position += conjugate - times_hat<S>(conjugate, S(0.5) * p.increment);
    slopes.increment += times_hat<S>(conjugate, p.arm);
    slopes.spin += times_hat<S>(S(0.5) * map.lazyProduct(p.end_rotation.transpose()), p.stretch);
  }
  /// Of one that K act on.
  void add_conjugate_curvature_part(const Matrix3T<S>& stiffness, ResultantSlopes<S>& slopes) const {
    const Matrix3T<S> map = factor * weighted_average.lazyProduct(stiffness);
    slopes.increment_derivative += map.lazyProduct(p.average_rotation.transpose());
    slopes.spin += times_hat<S>(S(0.5) * map.lazyProduct(p.end_rotation.transpose()), p.increment_derivative);
  }
  /// Of the turn of Lambda_bar under a constant stress.
  void add_turn(const Vector3T<S>& stress, ResultantSlopes<S>& slopes) const {
    slopes.spin -= so3::hat(Vector3T<S>(S(0.5) * (p.end_rotation * stress)));
  }

 private:
  static void set(const Matrix3T<S>& value, bool adds, Matrix3T<S>& target) {
    if (adds)
      target += value;
    else
      target = value;
  }
};

/// Adds {I^i' n, I_t^i' m - I_t^i (arm x n)} to the residual. The test functions sum to I, their derivatives to 0: the
/// last node takes what the others leave.
template <int Nodes, typename S>
void add_residual(const NodalValues<Nodes, S>& derivative, const GeneralisedShapeFunctions<Nodes, S>& tests,
                  const Vector3T<S>& n, const Vector3T<S>& m, const Vector3T<S>& arm,
                  std::array<Vector6T<S>, Nodes>& residual) {
  const Vector3T<S> couple = so3::cross(arm, n);
  Vector3T<S> rest = -couple;
  for (int i = 0; i < Nodes; ++i) {
    residual[i].template head<3>() += derivative[i] * n;
    if (i == Nodes - 1) break;
    Vector3T<S> moment = tests.derivatives[i].transpose() * m;
    moment -= tests.values[i].transpose() * couple;
    residual[i].template tail<3>() += moment;
    rest -= moment;
  }
  residual[Nodes - 1].template tail<3>() += rest;
}

/// Rows of the moments: tests' m - tests couple for every node, `visit(i, rows)`.
template <int Nodes, typename S, class Visit>
void for_moment_rows(const GeneralisedShapeFunctions<Nodes, S>& tests, const Matrix3T<S>* m, const Matrix3T<S>& couple,
                     const Visit& visit) {
  Matrix3T<S> rest = -couple;
  for (int i = 0; i < Nodes - 1; ++i) {
    Matrix3T<S> rows = -(tests.values[i].transpose().lazyProduct(couple));
    if (m) rows.noalias() += tests.derivatives[i].transpose().lazyProduct(*m);
    rest -= rows;
    visit(i, rows);
  }
  visit(Nodes - 1, rest);
}

/// Adds the tangent of add_residual. `n`: weighted; `dn`, `dm`: slopes of n and m.
template <int Nodes, typename S>
void add_tangent(const NodalValues<Nodes, S>& derivative, const GeneralisedShapeFunctions<Nodes, S>& tests,
                 const Point<Nodes, S>& p, const std::array<Matrix3T<S>, Nodes>& inverse_tangent, bool is_coupled,
                 const Vector3T<S>& n, const ResultantSlopes<S>& dn, const ResultantSlopes<S>& dm,
                 BlockTangent<Nodes, S>& tangent) {
  {
    Matrix3T<S> couple = hat_times<S>(p.arm, dn.position);
    couple -= so3::hat(Vector3T<S>(S(0.5) * n));
    for_moment_rows<Nodes, S>(tests, is_coupled ? &dm.position : nullptr, couple, [&](int i, const Matrix3T<S>& rows) {
      for (int j = 0; j < Nodes; ++j) {
        Matrix6T<S>& block = tangent[i][j];
        block.template topLeftCorner<3, 3>() += (derivative[i] * derivative[j]) * dn.position;
        block.template bottomLeftCorner<3, 3>() += derivative[j] * rows;
      }
    });
  }
  for (int j = 0; j < Nodes; ++j) {
    const Matrix3T<S>&spin = p.generalised.values[j], &spin_derivative = p.generalised.derivatives[j];
    Matrix3T<S> by_increment = dn.increment.lazyProduct(tests.values[j]);
    if (is_coupled) by_increment += dn.increment_derivative.lazyProduct(tests.derivatives[j]);
    Matrix3T<S> force = dn.spin.lazyProduct(spin);
    force += by_increment.lazyProduct(inverse_tangent[j]);
    if (is_coupled) force += dn.spin_derivative.lazyProduct(spin_derivative);

    by_increment = dm.increment_derivative.lazyProduct(tests.derivatives[j]);
    if (is_coupled) by_increment += dm.increment.lazyProduct(tests.values[j]);
    Matrix3T<S> moment = dm.spin.lazyProduct(spin);
    moment += dm.spin_derivative.lazyProduct(spin_derivative);
    moment += by_increment.lazyProduct(inverse_tangent[j]);

    for_moment_rows<Nodes, S>(tests, &moment, hat_times<S>(p.arm, force), [&](int i, const Matrix3T<S>& rows) {
      Matrix6T<S>& block = tangent[i][j];
      block.template topRightCorner<3, 3>() += derivative[i] * force;
      block.template bottomRightCorner<3, 3>() += rows;
    });
  }
}

}  // namespace flexarm::conserving
