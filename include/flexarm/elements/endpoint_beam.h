#pragma once
/// Beam residual and tangent at one configuration: statics, natural modes and the Newmark family
/// (beam.md 2.2, 2.5, 3.1).

#include "flexarm/elements/beam_point.h"
#include "flexarm/math/so3.h"

namespace flexarm {

/// Newmark's rule a_1 = (Delta x - h v_0 - (1/2 - beta) h^2 a_0) / (beta h^2), v_1 = v_0 + h ((1 - gamma) a_0 + gamma
/// a_1), for translations and, with Delta x the material rotation increment, for rotations (Muñoz 2004, eq. 4.1-4.4).
struct NewmarkRule {
  double beta = 0.25, gamma = 0.5, step = 0;

  Vector3 acceleration(const Vector3& increment, const Vector3& velocity, const Vector3& acceleration) const {
    return (increment - step * velocity - (0.5 - beta) * step * step * acceleration) / (beta * step * step);
  }
  Vector3 velocity(const Vector3& velocity, const Vector3& acceleration, const Vector3& new_acceleration) const {
    return velocity + step * ((1 - gamma) * acceleration + gamma * new_acceleration);
  }
  double acceleration_slope() const { return 1 / (beta * step * step); }
  double velocity_slope() const { return gamma / (beta * step); }
};

namespace endpoint {

/// Linearisation of {n, m} and of r' x n at a point; columns {dr', spin, spin'} (Muñoz 2004, eq. F.9, F.27).
struct PointTangent {
  Eigen::Matrix<double, 6, 9> resultants;
  Eigen::Matrix<double, 3, 9> couple;
};

/// `stress_slope`: d(stress)/d(strain) = stress_slope * stiffness (1, or more with damping).
inline PointTangent point_tangent(const PointKinematics& point, const Matrix6& stiffness, double stress_slope,
                                  const Vector3& n, const Vector3& m) {
  const Matrix3& rotation = point.rotation;
  const Eigen::Matrix<double, 6, 9> stress = stress_slope * stiffness.lazyProduct(strain_derivative(point));
  PointTangent d;
  d.resultants.topRows<3>().noalias() = rotation.lazyProduct(stress.topRows<3>());
  d.resultants.bottomRows<3>().noalias() = rotation.lazyProduct(stress.bottomRows<3>());
  d.resultants.block<3, 3>(0, 3) -= so3::hat(n);
  d.resultants.block<3, 3>(3, 3) -= so3::hat(m);
  d.couple = so3::hat(point.tangent) * d.resultants.topRows<3>();
  d.couple.leftCols<3>() -= so3::hat(n);
  return d;
}

}  // namespace endpoint

/// Internal forces of one element at the end configuration; its stiffness points go to `end`.
/// With a rule (dynamics): stiffness-proportional damping from `strain_rates` at the begin (overwritten with those at
/// the end if `update_rates`), and `begin` the points at the begin.
template <int Nodes>
void endpoint_internal(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule* rule,
                       const PointKinematics* begin, const Vector6* strain_rates, bool with_tangent,
                       PointKinematics* end, Vector6* new_strain_rates, ElementSystem<Nodes>& system) {
  using Element = BeamElement<Nodes>;
  const ElementRotations<Nodes> rotations(nodes.orientation, with_tangent);
  const bool damped = rule && element.stiffness_damping > 0;
  for (int k = 0; k < Element::kStiffnessPoints; ++k) {
    const auto& constants = element.stiffness_points[k];
    GeneralisedShapeFunctions<Nodes> generalised;
    const auto rotation = rotations.evaluate(constants.shape, constants.derivative, generalised);
    end[k] =
        point_kinematics(rotation, interpolate<Nodes>(constants.derivative, nodes.end), constants.reference_strain);
    Vector6 stress = element.stiffness * end[k].strain;
    double slope = 1;
    if (damped) {
      const Vector6 increment = end[k].strain - begin[k].strain;
      const Vector6 rate = (increment / rule->step - (1 - rule->gamma) * strain_rates[k]) / rule->gamma;
      const Vector6 damping_stress = element.stiffness_damping * (element.stiffness * rate);
      stress += damping_stress;
      slope += element.stiffness_damping / (rule->gamma * rule->step);
      system.dissipated += constants.weight * damping_stress.dot(increment);
      new_strain_rates[k] = rate;
    }
    const Vector3 n = end[k].rotation * stress.head<3>(), m = end[k].rotation * stress.tail<3>();
    const LagrangeTests<Nodes> tests{constants.shape, constants.derivative};
    add_point_residual<Nodes>(constants.weight, constants.derivative, tests, n, m, end[k].tangent, system.residual);
    if (!with_tangent) continue;
    const endpoint::PointTangent d = endpoint::point_tangent(end[k], element.stiffness, slope, n, m);
    add_point_tangent<Nodes, kInstantColumns>(constants.weight, tests, {constants.derivative, generalised, generalised},
                                              d.resultants, d.couple, system.tangent);
  }
}

/// Newmark translational inertia and mass-proportional damping.
template <int Nodes>
void newmark_translation(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule& rule,
                         bool with_tangent, ElementSystem<Nodes>& system) {
  std::array<Vector3, Nodes> force;
  for (int i = 0; i < Nodes; ++i) {
    const Vector3 increment = nodes.end[i] - nodes.begin[i];
    const Vector3 a = rule.acceleration(increment, nodes.velocity[i], nodes.acceleration[i]);
    const Vector3 v = rule.velocity(nodes.velocity[i], nodes.acceleration[i], a);
    force[i] = a + element.mass_damping * v;
    for (int j = 0; j < Nodes && element.mass_damping > 0; ++j)
      system.dissipated += element.mass_damping * element.mass(i, j) * v.dot(nodes.end[j] - nodes.begin[j]);
  }
  add_translational<Nodes>(element.mass, force,
                           rule.acceleration_slope() + element.mass_damping * rule.velocity_slope(), with_tangent,
                           system);
}

}  // namespace flexarm
