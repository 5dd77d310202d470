#pragma once
/// The tangent of the beams of conserving_beam.h. It is computed in 3 x 3 blocks in world axes, since most blocks of a
/// point are zero, and more so if the section does not couple forces with curvatures.

#include "elements/conserving_beam.h"
#include "math/cayley.h"

namespace flexarm::conserving {

/// Adds a linear form of a point to a row with respect to the nodes' {dr, spin}.
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

/// Derivatives of a stress resultant with respect to a point's {dr', spin, spin', dw, dw'}, in world axes.
template <typename S>
struct ResultantSlopes {
  Matrix3T<S> position, spin, spin_derivative, increment, increment_derivative;
};

/// Computes the contributions of 3 x 3 stiffness blocks to the derivatives of the weighted resultants: weight
/// Lambda_bar C (d(strain at the end) / 2 + factor ds).
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

  /// For a block that multiplies strains Gamma. Sets the derivatives with respect to dr' and dw; sets that with respect
  /// to the spin, or `adds` to it.
  void set_strain_part(const Matrix3T<S>& stiffness, bool adds, ResultantSlopes<S>& slopes) const {
    const Matrix3T<S> map = weighted_average.lazyProduct(stiffness);
    const Matrix3T<S> end = S(0.5) * map.lazyProduct(p.end_rotation.transpose());
    const Matrix3T<S> conjugate = factor * map.lazyProduct(p.average_rotation.transpose());
    slopes.position = end + conjugate - times_hat<S>(conjugate, S(0.5) * p.increment);
    slopes.increment = times_hat<S>(conjugate, p.arm);
    set(times_hat<S>(end, spin_strain), adds, slopes.spin);
  }
  /// For a block that multiplies curvatures K. Sets the derivatives with respect to spin' and dw'; sets that with
  /// respect to the spin, or `adds` to it.
  void set_curvature_part(const Matrix3T<S>& stiffness, bool adds, ResultantSlopes<S>& slopes) const {
    const Matrix3T<S> map = weighted_average.lazyProduct(stiffness);
    slopes.spin_derivative = S(0.5) * map.lazyProduct(p.end_rotation.transpose());
    slopes.increment_derivative = factor * map.lazyProduct(p.average_rotation.transpose());
    set(times_hat<S>(slopes.spin_derivative, spin_curvature), adds, slopes.spin);
  }
  /// For a block that multiplies Gamma: adds the derivatives of the part factor ds alone.
  void add_conjugate_strain_part(const Matrix3T<S>& stiffness, ResultantSlopes<S>& slopes) const {
    const Matrix3T<S> map = factor * weighted_average.lazyProduct(stiffness);
    const Matrix3T<S> conjugate = map.lazyProduct(p.average_rotation.transpose());
    slopes.position += conjugate - times_hat<S>(conjugate, S(0.5) * p.increment);
    slopes.increment += times_hat<S>(conjugate, p.arm);
    slopes.spin += times_hat<S>(S(0.5) * map.lazyProduct(p.end_rotation.transpose()), p.stretch);
  }
  /// For a block that multiplies K: adds the derivatives of the part factor ds alone.
  void add_conjugate_curvature_part(const Matrix3T<S>& stiffness, ResultantSlopes<S>& slopes) const {
    const Matrix3T<S> map = factor * weighted_average.lazyProduct(stiffness);
    slopes.increment_derivative += map.lazyProduct(p.average_rotation.transpose());
    slopes.spin += times_hat<S>(S(0.5) * map.lazyProduct(p.end_rotation.transpose()), p.increment_derivative);
  }
  /// Adds the geometric part: the derivative due to the rotation of Lambda_bar at constant stress.
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

/// Calls visit(i, rows) with the moment rows I_t^i'^T m - I_t^i^T couple of every node i. `m` may be null.
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

/// Adds the tangent of add_resultants(). `n`: weighted force; `dn`, `dm`: derivatives of n and m. `is_coupled`: see
/// SectionStiffness.
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

/// Adds the tangent of an element's internal forces, after set_forces().
template <int Nodes, typename S>
void add_tangent(const ConservingElement<Nodes, S>& element, const BeamNodes<Nodes, S>& nodes, const TimeRule& rule,
                 const StepPoints<Nodes, S>& at, const EnergyMultiplier<Nodes, S>& multiplier,
                 BlockSystem<Nodes, S>& system) {
  const ElementFunctions<Nodes, S>& mid = *at.mid;
  const bool is_corrected = rule.correction == EnergyCorrection::Multiplier;
  const bool is_uneven = element.has_stiffness_damping && !element.is_damped_evenly;
  std::array<Matrix3T<S>, Nodes> inverse_tangent;  // S(w)^{-1}: dw = S^{-1} spin
  std::array<Vector6T<S>, Nodes> work_row;
  for (int i = 0; i < Nodes; ++i) {
    inverse_tangent[i] = cayley::inverse_tangent(nodes.increment[i]);
    work_row[i].setConstant(S(0));
  }
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& constants = element.points[k];
    const SectionStiffness<S>& section = element.section(k);
    const Point<Nodes, S>& p = at.points[k];
    const bool is_coupled = section.is_coupled;
    const SlopeBuilder<Nodes, S> slope(p, constants.weight, p.factor);
    ResultantSlopes<S> dn, dm;
    slope.set_strain_part(section.forces, false, dn);
    slope.set_curvature_part(section.moments, false, dm);
    if (is_coupled) {
      slope.set_curvature_part(section.coupling, true, dn);
      slope.set_strain_part(section.coupling.transpose(), true, dm);
    } else {  // not used; avoids compiler warnings
      dn.spin_derivative.setConstant(S(0));
      dn.increment_derivative.setConstant(S(0));
      dm.position.setConstant(S(0));
      dm.increment.setConstant(S(0));
    }
    if (is_uneven) {
      const SectionStiffness<S> damped = element.damped_section(k);
      const SlopeBuilder<Nodes, S> damping(p, constants.weight, p.damped_factor);
      damping.add_conjugate_strain_part(damped.forces, dn);
      damping.add_conjugate_curvature_part(damped.moments, dm);
      if (is_coupled) {
        damping.add_conjugate_curvature_part(damped.coupling, dn);
        damping.add_conjugate_strain_part(damped.coupling.transpose(), dm);
      }
    }
    const Vector3T<S> force = p.seen_resultants.template head<3>();
    slope.add_turn(force, dn);
    slope.add_turn(p.seen_resultants.template tail<3>(), dm);
    add_tangent<Nodes, S>(constants.derivative, mid[k], p, inverse_tangent, is_coupled, p.average_rotation * force, dn,
                          dm, system.tangent);
    if (!is_corrected) continue;
    add_form<Nodes, S>(multiplier.form(constants.weight, p), constants.derivative, p.generalised, mid[k],
                       inverse_tangent, work_row);
  }
  if (is_corrected) multiplier.add_tangent(work_row, inverse_tangent, system.tangent);
}

}  // namespace flexarm::conserving
