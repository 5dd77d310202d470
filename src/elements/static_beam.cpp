#include "elements/static_beam.h"

#include <cassert>

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
void SpinForm::add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const PlacedNodes<Nodes>&,
                         const GeneralisedShapeFunctions<Nodes>& generalised, const endpoint::PointForces& point,
                         bool with_tangent, ElementSystem<Nodes>& system) {
  const LagrangeTests<Nodes> tests{constants.shape, constants.derivative};
  add_tested_point(constants, tests, generalised, point, with_tangent, system);
}

template <int Nodes>
void VariationForm::add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const PlacedNodes<Nodes>&,
                              const GeneralisedShapeFunctions<Nodes>& generalised, const endpoint::PointForces& point,
                              bool with_tangent, ElementSystem<Nodes>& system) {
  const GeneralisedTests<Nodes> tests{generalised};
  add_tested_point(constants, tests, generalised, point, with_tangent, system);
}

template <int Nodes, class Form>
void static_beam(const BeamElement<Nodes>& element, const PlacedNodes<Nodes>& nodes, bool with_tangent,
                 PointKinematics* end, ElementSystem<Nodes>& system, const Vector6* carried) {
  assert(end);
  ElasticLaw<Nodes> law{element};
  const LocalRotationAt<Nodes> rotation_at(element, nodes, Form::needs_variation(with_tangent));
  add_internal_forces<Nodes, Form>(element, nodes, rotation_at, law, with_tangent, end, system, carried);
}

// Explicit instantiations for each order of elements.
#define COMPILE_FOR(Nodes)                                                            \
  template decltype(SpinForm::add_point<Nodes>) SpinForm::add_point<Nodes>;           \
  template decltype(VariationForm::add_point<Nodes>) VariationForm::add_point<Nodes>; \
  template decltype(static_beam<Nodes, SpinForm>) static_beam<Nodes, SpinForm>;       \
  template decltype(static_beam<Nodes, VariationForm>) static_beam<Nodes, VariationForm>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
