#pragma once
/// Beam residual and tangent over a step for the energy-momentum (EM) family (beam.md 3.2, beyond.md 1):
///   g_v^i = int {I^i' n,  I_t^i' m - I_t^i r'_* x n} ds,  n = Lambda_bar N_a,  m = Lambda_bar M_a.
/// Momenta are conserved for any stress N_a, M_a and any test functions with sum I_t = 1, if the arm r'_* suits the
/// rule of the velocities.
///
/// One source for one element (S = double) and for four of them side by side (S = Pack). The algebra is by 3 x 3 blocks
/// in world axes: the linearisation of a point has few of them that are not zero, and fewer still where the section
/// couples no forces with curvatures.

#include "flexarm/elements/beam_point.h"
#include "flexarm/elements/conserving_element.h"
#include "flexarm/elements/time_rule.h"
#include "flexarm/math/cayley.h"
#include "flexarm/math/so3.h"

namespace flexarm {

/// Generalised shape functions at the stiffness points of an element.
template <int Nodes, typename S = double>
using ElementFunctions = std::array<GeneralisedShapeFunctions<Nodes, S>, Nodes - 1>;

/// Their values for given nodal rotations.
template <int Nodes, typename S>
void element_functions(const ConservingElement<Nodes, S>& element, const std::array<QuaternionT<S>, Nodes>& orientation,
                       ElementFunctions<Nodes, S>& functions) {
  const LocalRotationVariation<Nodes, S> local{LocalRotations<Nodes, S>(orientation)};
  for (int k = 0; k < Nodes - 1; ++k)
    local.evaluate(element.points[k].shape, element.points[k].derivative, functions[k]);
}

/// The stiffness points for given nodal positions and rotations.
template <int Nodes, typename S>
void element_points(const ConservingElement<Nodes, S>& element, const std::array<Vector3T<S>, Nodes>& position,
                    const std::array<QuaternionT<S>, Nodes>& orientation, PointKinematicsT<S>* points) {
  const LocalRotations<Nodes, S> local(orientation);
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& constants = element.points[k];
    points[k] = point_kinematics(local.evaluate(constants.shape, constants.derivative),
                                 interpolate<Nodes>(constants.derivative, position), constants.reference_strain);
  }
}

namespace conserving {

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

/// A stiffness point over a step.
template <int Nodes, typename S>
struct Point {
  GeneralisedShapeFunctions<Nodes, S> generalised;  // at the end
  Matrix3T<S> end_rotation, average_rotation;       // Lambda_{n+1}, (Lambda_n + Lambda_{n+1}) / 2
  Vector3T<S> end_tangent, arm;                     // r'_{n+1}, (r'_n + r'_{n+1}) / 2
  Vector3T<S> increment, increment_derivative;      // interpolated w and w'
  Vector3T<S> stretch;                              // x = Delta r' + arm x w
  Vector6T<S> stress;                               // average of both ends
  Vector6T<S> conjugate_strain, conjugate_stress;   // s and C s
  Vector6T<S> energy_stress;                        // C (Delta Sigma - s) / 2 + stress
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
  p.stress = stiffness.stress(S(0.5) * (begin.strain + end.strain));
  p.increment = mid.values[0] * nodes.increment[0];
  p.increment_derivative = mid.derivatives[0] * nodes.increment[0];
  for (int i = 1; i < Nodes; ++i) {
    p.increment += mid.values[i] * nodes.increment[i];
    p.increment_derivative += mid.derivatives[i] * nodes.increment[i];
  }
  p.stretch = end.tangent - begin.tangent + so3::cross(p.arm, p.increment);
  p.conjugate_strain.template head<3>() = p.average_rotation.transpose() * p.stretch;
  p.conjugate_strain.template tail<3>() = p.average_rotation.transpose() * p.increment_derivative;
  p.conjugate_stress = stiffness.stress(p.conjugate_strain);
}

/// A linear form of {dr', spin, spin', dw, dw'} of a point.
template <typename S>
struct PointForm {
  Vector3T<S> position, spin, spin_derivative, increment, increment_derivative;
};

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

/// The element's energy multiplier lambda.
template <int Nodes, typename S>
struct Multiplier {
  S numerator = S(0), denominator = S(0), reference = S(0);

  void add(const S& weight, const SectionStiffness<S>& stiffness, const PointKinematicsT<S>& begin,
           const PointKinematicsT<S>& end, Point<Nodes, S>& p) {
    // Tangent-scaled vector of Q = Lambda_{n+1} Lambda_n^T: 4 vee(Q) / (1 + tr Q).
    Vector3T<S> axial = so3::cross(begin.rotation.col(0), end.rotation.col(0));
    S trace = so3::dot(begin.rotation.col(0), end.rotation.col(0));
    for (int c = 1; c < 3; ++c) {
      axial += so3::cross(begin.rotation.col(c), end.rotation.col(c));
      trace += so3::dot(begin.rotation.col(c), end.rotation.col(c));
    }
    const Vector3T<S> turn = (S(2) / (S(1) + trace)) * axial;
    // Delta Gamma - s_Gamma = Lambda_bar^T (arm x (w_point - w)), free of cancellation.
    Vector6T<S> defect;  // Delta Sigma - s
    defect.template head<3>() = p.average_rotation.transpose() * so3::cross(p.arm, Vector3T<S>(turn - p.increment));
    defect.template tail<3>() =
        end.strain.template tail<3>() - begin.strain.template tail<3>() - p.conjugate_strain.template tail<3>();
    numerator += weight * dot6(p.stress, defect);
    denominator += weight * dot6(p.conjugate_strain, p.conjugate_stress);
    reference += S(0.5) * weight * dot6(Vector6T<S>(end.strain + begin.strain), p.stress);
    p.energy_stress = S(0.5) * stiffness.stress(defect) + p.stress;
  }

  /// lambda = num den / (den^2 + eps^2): the guard switches the correction off where the element does not deform.
  S guarded_square() const {
    using std::abs;
    const S guard = S(1e-16) * abs(reference) + S(1e-60);
    return denominator * denominator + guard * guard;
  }
  S value() const { return numerator * denominator / guarded_square(); }
  /// d(lambda) as a linear form at a point.
  PointForm<S> form(const S& weight, const Point<Nodes, S>& p) const {
    const S q = guarded_square();
    const S of_numerator = weight * (denominator / q);
    const S of_denominator = weight * (numerator / q) * (S(1) - S(2) * denominator * (denominator / q));
    return strain_form<Nodes, S>(p, (S(2) * of_denominator) * p.conjugate_stress - of_numerator * p.stress,
                                 of_numerator * p.energy_stress);
  }
};

/// d(lambda) as a row of the nodes' {dr, spin}.
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

/// The numerical damper at a stiffness point, see NumericalDissipation: what it adds to the stress is
/// factor C s - remembered, and what it knows at the end.
template <typename S>
struct NumericalDamper {
  S factor, dissipated;  // [-], [J/m]
  Vector6T<S> remembered;
  StrainMemoryT<S> end;

  NumericalDamper(const NumericalDissipation& d, const StrainMemoryT<S>& begin, const Vector6T<S>& s,
                  const SectionStiffness<S>& stiffness, double step)
      : factor(d.stiffness + 2 * d.inertance / (step * step)) {
    const Vector6T<S> deviation = s - begin.average;
    remembered = stiffness.stress(S(d.stiffness) * begin.average + S(2 * d.inertance / step) * begin.rate);
    dissipated = S(d.stiffness * (1 - 0.5 * d.forgetting)) * dot6(deviation, stiffness.stress(deviation));
    end.average = begin.average + S(d.forgetting) * deviation;
    end.rate = S(2 / step) * s - begin.rate;
  }
};

/// Translational inertia (1/h) int I^i I^j mass (v_{n+1} - v_n), v_{n+1} = factor Delta r / h - (factor - 1) v_n, and
/// mass-proportional damping by the mean velocity Delta r / h. Sets the system.
template <int Nodes, typename S>
void set_translation(const ConservingElement<Nodes, S>& element, const BeamNodes<Nodes, S>& nodes, double factor,
                     double step, bool with_tangent, BlockSystem<Nodes, S>& system) {
  std::array<Vector3T<S>, Nodes> mean, force;
  S slope = S(factor / (step * step));
  for (int i = 0; i < Nodes; ++i) {
    mean[i] = S(1 / step) * (nodes.end[i] - nodes.begin[i]);
    force[i] = S(factor / step) * (mean[i] - nodes.velocity[i]);
  }
  system.dissipated = S(0);
  if (element.has_mass_damping) {
    slope += element.mass_damping * S(1 / step);
    for (int i = 0; i < Nodes; ++i) {
      force[i] += element.mass_damping * mean[i];
      for (int j = 0; j < Nodes; ++j)
        system.dissipated += element.mass_damping * S(step) * element.mass(i, j) * so3::dot(mean[i], mean[j]);
    }
  }
  for (int i = 0; i < Nodes; ++i) {
    Vector3T<S> sum = element.mass(i, 0) * force[0];
    for (int j = 1; j < Nodes; ++j) sum += element.mass(i, j) * force[j];
    system.residual[i].template head<3>() = sum;
    system.residual[i].template tail<3>().setConstant(S(0));
    for (int j = 0; j < Nodes && with_tangent; ++j) {
      Matrix6T<S>& block = system.tangent[i][j];
      block.setConstant(S(0));
      block.diagonal().template head<3>().setConstant(slope * element.mass(i, j));
    }
  }
}

}  // namespace conserving

/// Internal forces, damping and translational inertia of one element over a step of length `step`, EM family. `begin`
/// holds the element's stiffness points at t_n, `end` receives those at t_{n+1}; `memory`, `end_memory` serve the
/// schemes with numerical dissipation. Rotary inertia is added elsewhere.
///
/// The moment rows are tested with, and the increments interpolated by, generalised shape functions of about the middle
/// of the step: `functions` are these (MidFunctions::Explicit) or those of the begin (Symmetric), which are averaged
/// with those of the end; then the tangent, which leaves their variation out, makes Newton converge linearly, by a
/// factor that falls with the step. Any of them conserve momenta (sum I_g = 1) and, with the multiplier, energy; those
/// of the middle make Delta(strain) - s third order in the step. With the Lagrange functions (beyond.md 1.1) it is
/// first order wherever an element is deformed, and the multiplier that makes up for it has no limit where the strain
/// comes to rest.
template <int Nodes, typename S>
void conserving_beam(const ConservingElement<Nodes, S>& element, const BeamNodes<Nodes, S>& nodes, const TimeRule& rule,
                     const ElementFunctions<Nodes, S>& functions, const PointKinematicsT<S>* begin,
                     const StrainMemoryT<S>* memory, double step, bool with_tangent, PointKinematicsT<S>* end,
                     StrainMemoryT<S>* end_memory, BlockSystem<Nodes, S>& system) {
  constexpr int kPoints = Nodes - 1;
  using conserving::Point;
  const bool is_symmetric = rule.mid_functions == MidFunctions::Symmetric;
  const bool is_corrected = rule.correction == EnergyCorrection::Multiplier;
  conserving::set_translation<Nodes, S>(element, nodes, rule.velocity_factor(), step, with_tangent, system);

  std::array<Point<Nodes, S>, kPoints> points;
  ElementFunctions<Nodes, S> averages;
  const LocalRotations<Nodes, S> rotations(nodes.orientation);
  std::array<InterpolatedRotation<S>, kPoints> rotation;
  if (with_tangent || is_symmetric) {
    const LocalRotationVariation<Nodes, S> variation(rotations);
    for (int k = 0; k < kPoints; ++k)
      rotation[k] = variation.evaluate(element.points[k].shape, element.points[k].derivative, points[k].generalised);
  } else {
    for (int k = 0; k < kPoints; ++k)
      rotation[k] = rotations.evaluate(element.points[k].shape, element.points[k].derivative);
  }
  for (int k = 0; k < kPoints && is_symmetric; ++k)
    for (int i = 0; i < Nodes; ++i) {
      averages[k].values[i] = S(0.5) * (functions[k].values[i] + points[k].generalised.values[i]);
      averages[k].derivatives[i] = S(0.5) * (functions[k].derivatives[i] + points[k].generalised.derivatives[i]);
    }
  const ElementFunctions<Nodes, S>& mid = is_symmetric ? averages : functions;

  conserving::Multiplier<Nodes, S> multiplier;
  for (int k = 0; k < kPoints; ++k) {
    const auto& constants = element.points[k];
    end[k] =
        point_kinematics(rotation[k], interpolate<Nodes>(constants.derivative, nodes.end), constants.reference_strain);
    conserving::set_strains<Nodes, S>(mid[k], element.stiffness, nodes, begin[k], end[k], points[k]);
    if (is_corrected) multiplier.add(constants.weight, element.stiffness, begin[k], end[k], points[k]);
  }

  const S viscosity = element.stiffness_damping * S(1 / step);
  const S lambda = is_corrected ? multiplier.value() : S(0);
  std::array<Matrix3T<S>, Nodes> inverse_tangent;  // S(w)^{-1}: dw = S^{-1} spin
  std::array<Vector6T<S>, Nodes> conjugate_residual, multiplier_row;
  for (int i = 0; i < Nodes && with_tangent; ++i) {
    inverse_tangent[i] = cayley::inverse_tangent(nodes.increment[i]);
    conjugate_residual[i].setConstant(S(0));
    multiplier_row[i].setConstant(S(0));
  }
  for (int k = 0; k < kPoints; ++k) {
    const auto& constants = element.points[k];
    const Point<Nodes, S>& p = points[k];
    S factor = lambda + viscosity;
    Vector6T<S> stress = p.stress;
    system.dissipated += constants.weight * viscosity * dot6(p.conjugate_strain, p.conjugate_stress);
    if (rule.dissipation.any()) {
      const conserving::NumericalDamper<S> damper(rule.dissipation, memory[k], p.conjugate_strain, element.stiffness,
                                                  step);
      factor += damper.factor;
      stress -= damper.remembered;
      system.dissipated += constants.weight * damper.dissipated;
      end_memory[k] = damper.end;
    }
    stress += factor * p.conjugate_stress;
    stress *= constants.weight;
    const Vector3T<S> force = stress.template head<3>(), moment = stress.template tail<3>();
    const Vector3T<S> n = p.average_rotation * force, m = p.average_rotation * moment;
    conserving::add_residual<Nodes, S>(constants.derivative, mid[k], n, m, p.arm, system.residual);
    if (!with_tangent) continue;

    const bool is_coupled = element.stiffness.is_coupled;
    const conserving::SlopeBuilder<Nodes, S> slope(p, constants.weight, factor);
    conserving::ResultantSlopes<S> dn, dm;
    slope.set_strain_part(element.stiffness.forces, false, dn);
    slope.set_curvature_part(element.stiffness.moments, false, dm);
    if (is_coupled) {
      slope.set_curvature_part(element.stiffness.coupling, true, dn);
      slope.set_strain_part(element.stiffness.coupling.transpose(), true, dm);
    } else {  // not used, but compilers warn
      dn.spin_derivative.setConstant(S(0));
      dn.increment_derivative.setConstant(S(0));
      dm.position.setConstant(S(0));
      dm.increment.setConstant(S(0));
    }
    slope.add_turn(force, dn);
    slope.add_turn(moment, dm);
    conserving::add_tangent<Nodes, S>(constants.derivative, mid[k], p, inverse_tangent, is_coupled, n, dn, dm,
                                      system.tangent);
    if (!is_corrected) continue;
    const Vector6T<S> conjugate = constants.weight * p.conjugate_stress;
    conserving::add_residual<Nodes, S>(constants.derivative, mid[k], p.average_rotation * conjugate.template head<3>(),
                                       p.average_rotation * conjugate.template tail<3>(), p.arm, conjugate_residual);
    conserving::add_form<Nodes, S>(multiplier.form(constants.weight, p), constants.derivative, p.generalised, mid[k],
                                   inverse_tangent, multiplier_row);
  }
  for (int i = 0; i < Nodes && is_corrected && with_tangent; ++i)
    for (int j = 0; j < Nodes; ++j)
      system.tangent[i][j] += conjugate_residual[i].lazyProduct(multiplier_row[j].transpose());
}

}  // namespace flexarm
