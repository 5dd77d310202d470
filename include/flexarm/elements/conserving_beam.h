#pragma once
/// Beam residual and tangent over a step for the conserving family (beam.md 3.2, beyond.md 1):
///   g_v^i = int {I^i' n,  I^i' m - I^i rbar' x n} ds,  n = Lambda_bar N_a,  m = A M_a,  rbar' the mid-point arm.
/// Momenta are conserved for any stress N_a, M_a and any A; the policies below choose them.

#include <cmath>

#include "flexarm/elements/beam_point.h"
#include "flexarm/math/cayley.h"
#include "flexarm/math/so3.h"

namespace flexarm {

/// EM0: A = Lambda_bar, stress the average of both ends (beyond.md 1.1).
struct AverageStress {
  static constexpr bool kConjugateStrain = true;  ///< uses the strain increment s conjugate to the nodal increments
  static constexpr bool kEnergyMultiplier = false;
};
/// EM: EM0 plus lambda C s, one multiplier per element that closes the energy balance (beyond.md 1.3).
struct DiscreteGradientStress {
  static constexpr bool kConjugateStrain = true;
  static constexpr bool kEnergyMultiplier = true;
};
/// M1: A = T(omega) Lambda_n, unscaled increments (Muñoz 2004, eq. 6.13-6.18).
struct ExponentialMoment {
  static constexpr bool kConjugateStrain = false;
  static constexpr bool kEnergyMultiplier = false;
};

namespace conserving {

/// A stiffness point over a step.
template <int Nodes>
struct Point {
  PointKinematics end;
  GeneralisedShapeFunctions<Nodes> generalised;
  Matrix3 average_rotation;  // (Lambda_n + Lambda_{n+1}) / 2
  Vector3 arm;               // (r'_n + r'_{n+1}) / 2
  Vector6 stress;            // average of both ends
  // Only with a conjugate strain:
  Vector3 increment, increment_derivative;     // interpolated w and w'
  Vector3 stretch;                             // x = Delta r' + arm x w
  Vector6 conjugate_strain, conjugate_stress;  // s and C s
};

/// d{Gamma, K} at the end of the step, columns {dr', spin, spin'}.
inline Eigen::Matrix<double, 6, 9> strain_derivative(const PointKinematics& point) {
  const Matrix3 transposed = point.rotation.transpose();
  Eigen::Matrix<double, 6, 9> d = Eigen::Matrix<double, 6, 9>::Zero();
  d.topLeftCorner<3, 3>() = transposed;
  d.block<3, 3>(0, 3) = transposed * so3::hat(point.tangent);
  d.bottomRightCorner<3, 3>() = transposed;
  return d;
}

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

template <int Nodes>
void set_conjugate_strain(const typename BeamElement<Nodes>::StiffnessPoint& constants, const Matrix6& stiffness,
                          const ElementNodes<Nodes>& nodes, const PointKinematics& begin, Point<Nodes>& p) {
  p.increment = interpolate<Nodes>(constants.shape, nodes.increment);
  p.increment_derivative = interpolate<Nodes>(constants.derivative, nodes.increment);
  p.stretch = p.end.tangent - begin.tangent + p.arm.cross(p.increment);
  p.conjugate_strain.template head<3>() = p.average_rotation.transpose() * p.stretch;
  p.conjugate_strain.template tail<3>() = p.average_rotation.transpose() * p.increment_derivative;
  p.conjugate_stress.noalias() = stiffness.lazyProduct(p.conjugate_strain);
}

/// The element's energy multiplier lambda and its derivative with respect to the nodal {dr, spin}.
template <int Nodes>
struct Multiplier {
  double numerator = 0, denominator = 0, reference = 0;
  Eigen::Matrix<double, 1, 6 * Nodes> numerator_derivative = Eigen::Matrix<double, 1, 6 * Nodes>::Zero();
  Eigen::Matrix<double, 1, 6 * Nodes> denominator_derivative = Eigen::Matrix<double, 1, 6 * Nodes>::Zero();

  void add(const typename BeamElement<Nodes>::StiffnessPoint& constants, const Matrix6& stiffness,
           const ElementNodes<Nodes>& nodes, const PointKinematics& begin, const Point<Nodes>& p, bool with_tangent) {
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
          node_columns<2, 15>(rows, constants.shape[j], constants.derivative[j], p.generalised.values[j],
                              p.generalised.derivatives[j], nodes.increment_inverse_tangent[j]);
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

/// Moment map A of the exponential form and d(A a) = derivative * spin for constant a.
struct ExponentialMap {
  Matrix3 map;
  Vector3 increment;
  Matrix3 begin_rotation;
  ExponentialMap(const Matrix3& begin, const Matrix3& end) : begin_rotation(begin) {
    increment = so3::log(Matrix3(end * begin.transpose()));
    map = so3::tangent(increment) * begin;
  }
  Matrix3 derivative(const Vector3& material) const {
    return so3::xi_tangent(increment, Vector3(begin_rotation * material)) * so3::inverse_tangent(increment);
  }
};

}  // namespace conserving

/// Internal forces, stiffness-proportional damping and translational inertia of one element over a step of length
/// `step`. `begin` holds the element's stiffness points at t_n, `end` receives those at t_{n+1}. Rotary inertia is
/// added elsewhere.
template <class Stress, int Nodes>
void conserving_beam(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const PointKinematics* begin,
                     double step, bool with_tangent, PointKinematics* end, ElementSystem<Nodes>& system) {
  using Element = BeamElement<Nodes>;
  constexpr int kColumns = Stress::kConjugateStrain ? kIncrementColumns : kInstantColumns;
  system.set_zero();

  const ElementRotations<Nodes> rotations(nodes.orientation, with_tangent);
  std::array<conserving::Point<Nodes>, Element::kStiffnessPoints> points;
  conserving::Multiplier<Nodes> multiplier;
  for (int k = 0; k < Element::kStiffnessPoints; ++k) {
    const auto& constants = element.stiffness_points[k];
    conserving::Point<Nodes>& p = points[k];
    const auto rotation = rotations.evaluate(constants.shape, constants.derivative, p.generalised);
    p.end = point_kinematics(rotation, interpolate<Nodes>(constants.derivative, nodes.end), constants.reference_strain);
    p.average_rotation = 0.5 * (begin[k].rotation + p.end.rotation);
    p.arm = 0.5 * (begin[k].tangent + p.end.tangent);
    p.stress.noalias() = element.stiffness.lazyProduct(0.5 * (begin[k].strain + p.end.strain));
    if constexpr (Stress::kConjugateStrain)
      conserving::set_conjugate_strain<Nodes>(constants, element.stiffness, nodes, begin[k], p);
    if constexpr (Stress::kEnergyMultiplier)
      multiplier.add(constants, element.stiffness, nodes, begin[k], p, with_tangent);
    end[k] = p.end;
  }
  const double lambda = Stress::kEnergyMultiplier ? multiplier.value() : 0.0;
  const double viscosity = element.stiffness_damping / step;
  Eigen::Matrix<double, 6 * Nodes, 1> conjugate_residual = Eigen::Matrix<double, 6 * Nodes, 1>::Zero();

  for (int k = 0; k < Element::kStiffnessPoints; ++k) {
    const auto& constants = element.stiffness_points[k];
    const conserving::Point<Nodes>& p = points[k];
    const Matrix3& average = p.average_rotation;
    Vector6 stress = p.stress;
    Eigen::Matrix<double, 6, kColumns> stress_derivative;
    Matrix3 moment_map, moment_derivative = Matrix3::Zero();
    if constexpr (Stress::kConjugateStrain) {
      stress += (lambda + viscosity) * p.conjugate_stress;
      system.dissipated += constants.weight * viscosity * p.conjugate_strain.dot(p.conjugate_stress);
      moment_map = average;
      if (with_tangent) {
        Eigen::Matrix<double, 6, 15> d = (lambda + viscosity) * conserving::conjugate_strain_derivative(p);
        d.template leftCols<9>() += 0.5 * conserving::strain_derivative(p.end);
        stress_derivative.noalias() = element.stiffness.lazyProduct(d);
        moment_derivative = -0.5 * so3::hat(Vector3(p.end.rotation * stress.tail<3>()));
      }
      if (Stress::kEnergyMultiplier && with_tangent)
        add_point_residual<Nodes>(constants.weight, constants.shape, constants.derivative,
                                  average * p.conjugate_stress.template head<3>(),
                                  average * p.conjugate_stress.template tail<3>(), p.arm, conjugate_residual);
    } else {
      const Vector6 strain_increment = p.end.strain - begin[k].strain;
      const Vector6 rate_stress = element.stiffness * strain_increment;
      stress += viscosity * rate_stress;
      system.dissipated += constants.weight * viscosity * strain_increment.dot(rate_stress);
      const conserving::ExponentialMap exponential(begin[k].rotation, p.end.rotation);
      moment_map = exponential.map;
      if (with_tangent) {
        stress_derivative.noalias() =
            element.stiffness.lazyProduct((0.5 + viscosity) * conserving::strain_derivative(p.end));
        moment_derivative = exponential.derivative(stress.tail<3>());
      }
    }

    const Vector3 n = average * stress.head<3>(), m = moment_map * stress.tail<3>();
    add_point_residual<Nodes>(constants.weight, constants.shape, constants.derivative, n, m, p.arm, system.residual);
    if (!with_tangent) continue;
    Eigen::Matrix<double, 6, kColumns> resultants;
    resultants.template topRows<3>().noalias() = average.lazyProduct(stress_derivative.template topRows<3>());
    resultants.template bottomRows<3>().noalias() = moment_map.lazyProduct(stress_derivative.template bottomRows<3>());
    resultants.template block<3, 3>(0, 3) -= 0.5 * so3::hat(Vector3(p.end.rotation * stress.head<3>()));
    resultants.template block<3, 3>(3, 3) += moment_derivative;
    Eigen::Matrix<double, 3, kColumns> couple = so3::hat(p.arm) * resultants.template topRows<3>();
    couple.template leftCols<3>() -= 0.5 * so3::hat(n);
    add_point_tangent<Nodes, kColumns>(constants.weight, constants.shape, constants.derivative, p.generalised,
                                       nodes.increment_inverse_tangent, resultants, couple, system.tangent);
  }
  if (Stress::kEnergyMultiplier && with_tangent)
    system.tangent.noalias() += conjugate_residual.lazyProduct(multiplier.derivative());

  // Translational inertia (1/step) int I^i I^j mass (v_{n+1} - v_n), v_{n+1} = 2 Delta r / step - v_n, and its damping.
  std::array<Vector3, Nodes> force;
  for (int i = 0; i < Nodes; ++i) {
    const Vector3 mean = (nodes.end[i] - nodes.begin[i]) / step;
    force[i] = (2 / step) * (mean - nodes.velocity[i]) + element.mass_damping * mean;
  }
  add_translational<Nodes>(element.mass, force, (2 / step + element.mass_damping) / step, with_tangent, system);
  if (element.mass_damping > 0)
    for (int i = 0; i < Nodes; ++i)
      for (int j = 0; j < Nodes; ++j)
        system.dissipated += element.mass_damping / step * element.mass(i, j) *
                             (nodes.end[i] - nodes.begin[i]).dot(nodes.end[j] - nodes.begin[j]);
}

}  // namespace flexarm
