#include "elements/endpoint_beam.h"

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

// Compiled here once for each order of elements.
#define COMPILE_FOR(Nodes)                                                            \
  template decltype(SpinForm::add_point<Nodes>) SpinForm::add_point<Nodes>;           \
  template decltype(VariationForm::add_point<Nodes>) VariationForm::add_point<Nodes>; \
  template decltype(newmark_translation<Nodes>) newmark_translation<Nodes>;           \
  template decltype(newmark_mass_damping<Nodes>) newmark_mass_damping<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
