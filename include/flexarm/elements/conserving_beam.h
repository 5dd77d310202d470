#pragma once
/// Beam residual and tangent over a step for the conserving family (beam.md 3.2, beyond.md 1):
///   g_v^i = int {I^i' n,  I_t^i' m - I_t^i r'_* x n} ds,  n = Lambda_bar N_a,  m = A M_a.
/// Momenta are conserved for any stress N_a, M_a, any A and any test functions with sum I_t = 1, if the arm r'_* suits
/// the rule of the velocities. Here the EM family and what it shares with the momentum-conserving schemes of
/// momentum_beam.h.

#include <cmath>

#include "flexarm/elements/beam_point.h"
#include "flexarm/elements/time_rule.h"
#include "flexarm/math/cayley.h"
#include "flexarm/math/so3.h"
#include "flexarm/model/state.h"

namespace flexarm {

namespace conserving {

/// A stiffness point over a step.
template <int Nodes>
struct Point {
  PointKinematics end;
  GeneralisedShapeFunctions<Nodes> generalised;
  GeneralisedShapeFunctions<Nodes>
      increments;            // of the interpolated increment's variation, mid-step functions times S^{-1}
  Matrix3 average_rotation;  // (Lambda_n + Lambda_{n+1}) / 2
  Vector3 arm;               // r'_*: (r'_n + r'_{n+1}) / 2, or r'_n
  double arm_weight;         // of the end in it
  Vector6 stress;            // average of both ends
  // Only with a conjugate strain:
  Vector3 increment, increment_derivative;     // interpolated w and w'
  Vector3 stretch;                             // x = Delta r' + arm x w
  Vector6 conjugate_strain, conjugate_stress;  // s and C s
};

/// ds, columns {dr', spin, spin', dw, dw'} (beyond.md 1.3).
template <int Nodes>
Eigen::Matrix<double, 6, 15> conjugate_strain_derivative(const Point<Nodes>& p) {
  const Matrix3 average = p.average_rotation.transpose(), half_end = 0.5 * p.end.rotation.transpose();
  Eigen::Matrix<double, 6, 15> d = Eigen::Matrix<double, 6, 15>::Zero();
  d.template block<3, 3>(0, 0) = average - 0.5 * average * so3::hat(p.increment);
  d.template block<3, 3>(0, 3) = half_end * so3::hat(p.stretch);
  d.template block<3, 3>(3, 3) = half_end * so3::hat(p.increment_derivative);
  d.template block<3, 3>(0, 9) = average * so3::hat(p.arm);
  d.template block<3, 3>(3, 12) = average;
  return d;
}

/// `mid`: generalised shape functions at about the middle of the step.
template <int Nodes>
void set_conjugate_strain(const GeneralisedShapeFunctions<Nodes>& mid, const Matrix6& stiffness,
                          const ElementNodes<Nodes>& nodes, const PointKinematics& begin, bool with_tangent,
                          Point<Nodes>& p) {
  p.increment.setZero();
  p.increment_derivative.setZero();
  for (int i = 0; i < Nodes; ++i) {
    p.increment += mid.values[i] * nodes.increment[i];
    p.increment_derivative += mid.derivatives[i] * nodes.increment[i];
  }
  p.stretch = p.end.tangent - begin.tangent + p.arm.cross(p.increment);
  p.conjugate_strain.template head<3>() = p.average_rotation.transpose() * p.stretch;
  p.conjugate_strain.template tail<3>() = p.average_rotation.transpose() * p.increment_derivative;
  p.conjugate_stress.noalias() = stiffness.lazyProduct(p.conjugate_strain);
  for (int i = 0; i < Nodes && with_tangent; ++i) {
    p.increments.values[i].noalias() = mid.values[i].lazyProduct(nodes.increment_inverse_tangent[i]);
    p.increments.derivatives[i].noalias() = mid.derivatives[i].lazyProduct(nodes.increment_inverse_tangent[i]);
  }
}

/// The element's energy multiplier lambda and its derivative with respect to the nodal {dr, spin}.
template <int Nodes>
struct Multiplier {
  double numerator = 0, denominator = 0, reference = 0;
  Eigen::Matrix<double, 1, 6 * Nodes> numerator_derivative = Eigen::Matrix<double, 1, 6 * Nodes>::Zero();
  Eigen::Matrix<double, 1, 6 * Nodes> denominator_derivative = Eigen::Matrix<double, 1, 6 * Nodes>::Zero();

  void add(const typename BeamElement<Nodes>::StiffnessPoint& constants, const Matrix6& stiffness,
           const PointKinematics& begin, const Point<Nodes>& p, bool with_tangent) {
    // Delta Gamma - s_Gamma = Lambda_bar^T (arm x (w_point - w)), free of cancellation.
    const Quaternion relative = so3::quaternion_from_matrix(p.end.rotation * begin.rotation.transpose());
    Vector6 defect;  // Delta Sigma - s
    defect.head<3>() = p.average_rotation.transpose() * p.arm.cross(Vector3(cayley::increment(relative) - p.increment));
    defect.tail<3>() =
        p.end.strain.template tail<3>() - begin.strain.template tail<3>() - p.conjugate_strain.template tail<3>();
    const double w = constants.weight;
    numerator += w * p.stress.dot(defect);
    denominator += w * p.conjugate_strain.dot(p.conjugate_stress);
    const Vector6 mean_strain = 0.5 * (p.end.strain + begin.strain);
    reference += w * mean_strain.dot(p.stress);
    if (!with_tangent) return;

    const Eigen::Matrix<double, 6, 15> ds = conjugate_strain_derivative(p);
    const Vector6 on_strain = 0.5 * (stiffness * defect) + p.stress;
    Eigen::Matrix<double, 2, 15> rows;
    rows.row(0).noalias() = -w * p.stress.transpose().lazyProduct(ds);
    rows.row(0).template head<9>().noalias() += w * on_strain.transpose().lazyProduct(strain_derivative(p.end));
    rows.row(1).noalias() = 2 * w * p.conjugate_stress.transpose().lazyProduct(ds);
    for (int j = 0; j < Nodes; ++j) {
      const Eigen::Matrix<double, 2, 6> d =
          node_columns<Nodes, 2, 15>(rows, {constants.derivative, p.generalised, p.increments}, j);
      numerator_derivative.template segment<6>(6 * j) += d.row(0);
      denominator_derivative.template segment<6>(6 * j) += d.row(1);
    }
  }

  /// lambda = num den / (den^2 + eps^2): the guard switches the correction off where the element does not deform.
  double guarded_square() const {
    const double guard = 1e-16 * std::abs(reference) + 1e-60;
    return denominator * denominator + guard * guard;
  }
  double value() const { return numerator * denominator / guarded_square(); }
  Eigen::Matrix<double, 1, 6 * Nodes> derivative() const {
    const double q = guarded_square();
    return (denominator / q) * numerator_derivative +
           (numerator / q) * (1 - 2 * denominator * (denominator / q)) * denominator_derivative;
  }
};

/// Stress resultants' material values at a point, the map of the moment to space, and their derivatives.
template <int Columns>
struct StressState {
  Vector6 stress;
  Eigen::Matrix<double, 6, Columns> stress_derivative;
  Matrix3 moment_map;                           // A
  Matrix3 moment_derivative = Matrix3::Zero();  // d(A a) / d(spin) at constant material moment a
};

/// EM family: stress + factor C s - remembered, A the average rotation.
template <int Nodes>
StressState<kIncrementColumns> conjugate_stress_state(const Matrix6& stiffness, const Point<Nodes>& p, double factor,
                                                      const Vector6& remembered, bool with_tangent) {
  StressState<kIncrementColumns> out;
  out.stress = p.stress + factor * p.conjugate_stress - remembered;
  out.moment_map = p.average_rotation;
  if (!with_tangent) return out;
  Eigen::Matrix<double, 6, 15> d = factor * conjugate_strain_derivative(p);
  d.template leftCols<9>() += 0.5 * strain_derivative(p.end);
  out.stress_derivative.noalias() = stiffness.lazyProduct(d);
  out.moment_derivative = -0.5 * so3::hat(Vector3(p.end.rotation * out.stress.template tail<3>()));
  return out;
}

/// Adds a point's forces and their tangent.
template <int Nodes, int Columns, class Tests>
void add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const Tests& tests, const Point<Nodes>& p,
               const StressState<Columns>& state, bool with_tangent, ElementSystem<Nodes>& system) {
  const Matrix3& average = p.average_rotation;
  const Vector3 n = average * state.stress.template head<3>(), m = state.moment_map * state.stress.template tail<3>();
  add_point_residual<Nodes>(constants.weight, constants.derivative, tests, n, m, p.arm, system.residual);
  if (!with_tangent) return;
  Eigen::Matrix<double, 6, Columns> resultants;
  resultants.template topRows<3>().noalias() = average.lazyProduct(state.stress_derivative.template topRows<3>());
  resultants.template bottomRows<3>().noalias() =
      state.moment_map.lazyProduct(state.stress_derivative.template bottomRows<3>());
  resultants.template block<3, 3>(0, 3) -= 0.5 * so3::hat(Vector3(p.end.rotation * state.stress.template head<3>()));
  resultants.template block<3, 3>(3, 3) += state.moment_derivative;
  Eigen::Matrix<double, 3, Columns> couple = so3::hat(p.arm) * resultants.template topRows<3>();
  couple.template leftCols<3>() -= p.arm_weight * so3::hat(n);
  add_point_tangent<Nodes, Columns>(constants.weight, tests, {constants.derivative, p.generalised, p.increments},
                                    resultants, couple, system.tangent);
}

/// The stiffness points of an element over a step; those at the end go to `end`.
template <int Nodes>
void evaluate_points(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const PointKinematics* begin,
                     double arm_weight, bool with_variation,
                     std::array<Point<Nodes>, BeamElement<Nodes>::kStiffnessPoints>& points, PointKinematics* end) {
  const ElementRotations<Nodes> rotations(nodes, with_variation);
  for (int k = 0; k < BeamElement<Nodes>::kStiffnessPoints; ++k) {
    const auto& constants = element.stiffness_points[k];
    Point<Nodes>& p = points[k];
    const auto* reference = nodes.stiffness_reference ? nodes.stiffness_reference + k : nullptr;
    const auto rotation = rotations.evaluate(constants.shape, constants.derivative, reference, p.generalised);
    p.end = point_kinematics(rotation, interpolate<Nodes>(constants.derivative, nodes.end), constants.reference_strain);
    p.average_rotation = 0.5 * (begin[k].rotation + p.end.rotation);
    p.arm_weight = arm_weight;
    p.arm = (1 - arm_weight) * begin[k].tangent + arm_weight * p.end.tangent;
    p.stress.noalias() = element.stiffness.lazyProduct(0.5 * (begin[k].strain + p.end.strain));
    end[k] = p.end;
  }
}

/// Translational inertia (1/h) int I^i I^j mass (v_{n+1} - v_n), v_{n+1} = factor Delta r / h - (factor - 1) v_n.
template <int Nodes>
void add_translational_inertia(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, double factor,
                               double step, bool with_tangent, ElementSystem<Nodes>& system) {
  std::array<Vector3, Nodes> force;
  for (int i = 0; i < Nodes; ++i)
    force[i] = (factor / step) * ((nodes.end[i] - nodes.begin[i]) / step - nodes.velocity[i]);
  add_translational<Nodes>(element.mass, force, factor / (step * step), with_tangent, system);
}

/// Mass-proportional damping by the mean velocity Delta r / h.
template <int Nodes>
void add_mass_damping(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, double step,
                      bool with_tangent, ElementSystem<Nodes>& system) {
  if (element.mass_damping == 0) return;
  std::array<Vector3, Nodes> mean, force;
  for (int i = 0; i < Nodes; ++i) {
    mean[i] = (nodes.end[i] - nodes.begin[i]) / step;
    force[i] = element.mass_damping * mean[i];
  }
  add_translational<Nodes>(element.mass, force, element.mass_damping / step, with_tangent, system);
  for (int i = 0; i < Nodes; ++i)
    for (int j = 0; j < Nodes; ++j)
      system.dissipated += element.mass_damping * step * element.mass(i, j) * mean[i].dot(mean[j]);
}

}  // namespace conserving

/// Generalised shape functions at the stiffness points of an element.
template <int Nodes>
using ElementFunctions = std::array<GeneralisedShapeFunctions<Nodes>, BeamElement<Nodes>::kStiffnessPoints>;

/// Those of the configuration with the given nodal rotations.
template <int Nodes>
void element_functions(const BeamElement<Nodes>& element, const std::array<Quaternion, Nodes>& orientation,
                       ElementFunctions<Nodes>& functions) {
  const LocalRotationVariation<Nodes> local{LocalRotations<Nodes>(orientation)};
  for (int k = 0; k < BeamElement<Nodes>::kStiffnessPoints; ++k)
    local.evaluate(element.stiffness_points[k].shape, element.stiffness_points[k].derivative, functions[k]);
}

/// The numerical damper at a stiffness point, see NumericalDissipation: what it adds to the stress is
/// factor C s - remembered, and what it knows at the end.
struct NumericalDamper {
  double factor = 0, dissipated = 0;  // [-], [J/m]
  Vector6 remembered = Vector6::Zero();
  StrainMemory end;

  NumericalDamper(const NumericalDissipation& d, const StrainMemory& begin, const Vector6& s, const Matrix6& stiffness,
                  double step) {
    const Vector6 deviation = s - begin.average;
    factor = d.stiffness + 2 * d.inertance / (step * step);
    remembered = stiffness * (d.stiffness * begin.average + (2 * d.inertance / step) * begin.rate);
    dissipated = d.stiffness * (1 - 0.5 * d.forgetting) * deviation.dot(stiffness * deviation);
    end.average = begin.average + d.forgetting * deviation;
    end.rate = (2 / step) * s - begin.rate;
  }
};

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
template <bool WithMultiplier, int Nodes>
void conserving_beam(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const TimeRule& rule,
                     const ElementFunctions<Nodes>& functions, const PointKinematics* begin, const StrainMemory* memory,
                     double step, bool with_tangent, PointKinematics* end, StrainMemory* end_memory,
                     ElementSystem<Nodes>& system) {
  constexpr int kPoints = BeamElement<Nodes>::kStiffnessPoints;
  const bool is_symmetric = rule.mid_functions == MidFunctions::Symmetric;
  system.set_zero();
  std::array<conserving::Point<Nodes>, kPoints> points;
  conserving::evaluate_points<Nodes>(element, nodes, begin, 0.5, with_tangent || is_symmetric, points, end);
  conserving::Multiplier<Nodes> multiplier;
  ElementFunctions<Nodes> averages;
  for (int k = 0; k < kPoints && is_symmetric; ++k)
    for (int i = 0; i < Nodes; ++i) {
      averages[k].values[i] = 0.5 * (functions[k].values[i] + points[k].generalised.values[i]);
      averages[k].derivatives[i] = 0.5 * (functions[k].derivatives[i] + points[k].generalised.derivatives[i]);
    }
  const ElementFunctions<Nodes>& mid = is_symmetric ? averages : functions;
  for (int k = 0; k < kPoints; ++k) {
    conserving::set_conjugate_strain<Nodes>(mid[k], element.stiffness, nodes, begin[k], with_tangent, points[k]);
    if constexpr (WithMultiplier)
      multiplier.add(element.stiffness_points[k], element.stiffness, begin[k], points[k], with_tangent);
  }

  const double lambda = WithMultiplier ? multiplier.value() : 0.0;
  const double viscosity = element.stiffness_damping / step;
  Eigen::Matrix<double, 6 * Nodes, 1> conjugate_residual = Eigen::Matrix<double, 6 * Nodes, 1>::Zero();
  for (int k = 0; k < kPoints; ++k) {
    const auto& constants = element.stiffness_points[k];
    const conserving::Point<Nodes>& p = points[k];
    const GeneralisedTests<Nodes> tests{mid[k]};
    double factor = lambda + viscosity;
    Vector6 remembered = Vector6::Zero();
    system.dissipated += constants.weight * viscosity * p.conjugate_strain.dot(p.conjugate_stress);
    if (rule.dissipation.any()) {
      const NumericalDamper damper(rule.dissipation, memory[k], p.conjugate_strain, element.stiffness, step);
      factor += damper.factor;
      remembered = damper.remembered;
      system.dissipated += constants.weight * damper.dissipated;
      end_memory[k] = damper.end;
    }
    conserving::add_point<Nodes>(
        constants, tests, p,
        conserving::conjugate_stress_state<Nodes>(element.stiffness, p, factor, remembered, with_tangent), with_tangent,
        system);
    if (WithMultiplier && with_tangent)
      add_point_residual<Nodes>(constants.weight, constants.derivative, tests,
                                p.average_rotation * p.conjugate_stress.template head<3>(),
                                p.average_rotation * p.conjugate_stress.template tail<3>(), p.arm, conjugate_residual);
  }
  if (WithMultiplier && with_tangent)
    system.tangent.noalias() += conjugate_residual.lazyProduct(multiplier.derivative());
  conserving::add_translational_inertia<Nodes>(element, nodes, rule.velocity_factor(), step, with_tangent, system);
  conserving::add_mass_damping<Nodes>(element, nodes, step, with_tangent, system);
}

}  // namespace flexarm
