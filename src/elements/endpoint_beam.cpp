#include "elements/endpoint_beam.h"

#include <cassert>

#include "elements/additive_beam.h"
#include "elements/orders.h"

namespace flexarm {

endpoint::PointTangent endpoint::point_tangent(const PointKinematics& point, const Matrix6& stiffness,
                                               double stress_slope, const Vector3& n, const Vector3& m) {
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

namespace {

template <int Nodes, class Tests>
void add_tested_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const Tests& tests,
                      const GeneralisedShapeFunctions<Nodes>& generalised, const endpoint::PointForces& point,
                      bool with_tangent, ElementSystem<Nodes>& system) {
  add_point_residual<Nodes>(constants.weight, constants.derivative, tests, point.n, point.m, point.kinematics.tangent,
                            system.residual);
  if (!with_tangent) return;
  const endpoint::PointTangent d =
      endpoint::point_tangent(point.kinematics, point.stiffness, point.stress_slope, point.seen_n, point.seen_m);
  add_point_residual<Nodes>(constants.weight, constants.derivative, tests, point.seen_n - point.n,
                            point.seen_m - point.m, point.kinematics.tangent, system.carried);
  add_point_tangent<Nodes>(constants.weight, tests, {constants.derivative, generalised}, d.resultants, d.couple,
                           system.tangent);
}

}  // namespace

template <int Nodes>
void SpinForm::add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const ElementNodes<Nodes>&,
                         const GeneralisedShapeFunctions<Nodes>& generalised, const endpoint::PointForces& point,
                         bool with_tangent, ElementSystem<Nodes>& system) {
  const LagrangeTests<Nodes> tests{constants.shape, constants.derivative};
  add_tested_point(constants, tests, generalised, point, with_tangent, system);
}

template <int Nodes>
void VariationForm::add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const ElementNodes<Nodes>&,
                              const GeneralisedShapeFunctions<Nodes>& generalised, const endpoint::PointForces& point,
                              bool with_tangent, ElementSystem<Nodes>& system) {
  const GeneralisedTests<Nodes> tests{generalised};
  add_tested_point(constants, tests, generalised, point, with_tangent, system);
}

template <int Nodes>
void newmark_translation(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule& rule,
                         bool with_tangent, ElementSystem<Nodes>& system) {
  std::array<Vector3, Nodes> acceleration;
  for (int i = 0; i < Nodes; ++i)
    acceleration[i] = rule.acceleration(nodes.end[i] - nodes.begin[i], nodes.velocity[i], nodes.acceleration[i]);
  add_translational<Nodes>(element.mass, acceleration, rule.acceleration_slope(), with_tangent, system);
}

template <int Nodes>
void newmark_mass_damping(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule& rule,
                          bool with_tangent, ElementSystem<Nodes>& system) {
  if (element.mass_damping == 0) return;
  std::array<Vector3, Nodes> force;
  for (int i = 0; i < Nodes; ++i) {
    const Vector3 a = rule.acceleration(nodes.end[i] - nodes.begin[i], nodes.velocity[i], nodes.acceleration[i]);
    const Vector3 v = rule.velocity(nodes.velocity[i], nodes.acceleration[i], a);
    force[i] = element.mass_damping * ((1 + rule.alpha) * v - rule.alpha * nodes.velocity[i]);
    for (int j = 0; j < Nodes; ++j)
      system.dissipated += element.mass(i, j) * force[i].dot(nodes.end[j] - nodes.begin[j]);
  }
  add_translational<Nodes>(element.mass, force, element.mass_damping * (1 + rule.alpha) * rule.velocity_slope(),
                           with_tangent, system);
}

namespace {

/// Stress at a point of a beam at the end of a step.
struct EndpointStress {
  Vector6 stress, strain_rate = Vector6::Zero();
  double slope = 1;       ///< d(stress)/d(strain) = stiffness + (slope - 1) damped, see add_damping()
  double dissipated = 0;  ///< over the step [J/m]

  /// The elastic stress.
  EndpointStress(const Matrix6& stiffness, const Vector6& strain) : stress(stiffness * strain) {}

  /// Adds stiffness-proportional damping by the strain rate at t_{n+1+alpha}. `damping`: eta, `damped`: D C D, see
  /// BeamElement::stiffness_damping. `begin`, `begin_rate`: strain and its rate at the beginning of the step.
  void add_damping(double damping, const Matrix6& damped, const Vector6& strain, const Vector6& begin,
                   const Vector6& begin_rate, const NewmarkRule& rule) {
    const Vector6 increment = (strain - begin) / (1 + rule.alpha);
    strain_rate = (increment / rule.step - (1 - rule.gamma) * begin_rate) / rule.gamma;
    const Vector6 rate = (1 + rule.alpha) * strain_rate - rule.alpha * begin_rate;
    const Vector6 damping_stress = damping * (damped * rate);
    stress += damping_stress;
    slope += damping / (rule.gamma * rule.step);
    dissipated = damping_stress.dot(increment);
  }
};

}  // namespace

template <int Nodes, class Form>
void endpoint_internal(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule* rule,
                       const PointKinematics* begin, const Vector6* strain_rates, bool with_tangent,
                       PointKinematics* end, Vector6* new_strain_rates, ElementSystem<Nodes>& system,
                       const Vector6* carried) {
  assert(end && new_strain_rates);
  assert(!rule || (begin && strain_rates && rule->step != 0));
  const ElementRotations<Nodes> rotations(nodes, Form::needs_variation(with_tangent));
  const bool is_even = is_damped_evenly(element);
  for (int k = 0; k < BeamElement<Nodes>::kStiffnessPoints; ++k) {
    const auto& constants = element.stiffness_points[k];
    Matrix6 damped;
    if (!is_even) damped = damped_stiffness(element, k);
    GeneralisedShapeFunctions<Nodes> generalised;
    const auto* reference = nodes.stiffness_reference ? nodes.stiffness_reference + k : nullptr;
    const auto rotation = rotations.evaluate(constants.shape, constants.derivative, reference, generalised);
    end[k] = end_kinematics<Nodes>(constants, nodes, rotation);
    const auto stress_at = [&](const Vector6& strain) {
      EndpointStress stress(constants.stiffness, strain);
      if (rule && element.stiffness_damping != 0)
        stress.add_damping(element.stiffness_damping, is_even ? constants.stiffness : damped, strain, begin[k].strain,
                           strain_rates[k], *rule);
      return stress;
    };
    const EndpointStress point = stress_at(end[k].strain);
    system.dissipated += constants.weight * point.dissipated;
    new_strain_rates[k] = point.strain_rate;
    const auto in_space = [&](const Vector3& material) -> Vector3 { return end[k].rotation * material; };
    const Vector3 n = in_space(point.stress.template head<3>()), m = in_space(point.stress.template tail<3>());
    const double slope = is_even ? point.slope : 1;
    Matrix6 sum;
    if (!is_even) sum = constants.stiffness + (point.slope - 1) * damped;
    endpoint::PointForces forces{end[k], is_even ? constants.stiffness : sum, slope, n, m, n, m};
    if (carried) {
      const EndpointStress seen = stress_at(carried[k]);
      forces.seen_n = in_space(seen.stress.template head<3>());
      forces.seen_m = in_space(seen.stress.template tail<3>());
    }
    Form::add_point(constants, nodes, generalised, forces, with_tangent, system);
  }
}

// Explicit instantiations for each order of elements.
#define COMPILE_FOR(Nodes)                                                                            \
  template decltype(SpinForm::add_point<Nodes>) SpinForm::add_point<Nodes>;                           \
  template decltype(VariationForm::add_point<Nodes>) VariationForm::add_point<Nodes>;                 \
  template decltype(newmark_translation<Nodes>) newmark_translation<Nodes>;                           \
  template decltype(newmark_mass_damping<Nodes>) newmark_mass_damping<Nodes>;                         \
  template decltype(endpoint_internal<Nodes, SpinForm>) endpoint_internal<Nodes, SpinForm>;           \
  template decltype(endpoint_internal<Nodes, VariationForm>) endpoint_internal<Nodes, VariationForm>; \
  template decltype(endpoint_internal<Nodes, AdditiveForm>) endpoint_internal<Nodes, AdditiveForm>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
