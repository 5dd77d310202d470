#include "analysis/element_matrices.h"

#include "elements/element_configuration.h"
#include "elements/orders.h"
#include "elements/static_beam.h"
#include "math/so3.h"

namespace flexarm {
namespace {

/// Calls `visit(constants, kinematics, generalised shape functions)` for every stiffness point.
template <int Nodes, class Visit>
void for_each_point(const BeamElement<Nodes>& element, const State& state, const Visit& visit) {
  const ElementConfiguration<Nodes> nodes(element, state);
  const LocalRotationVariation<Nodes> local{LocalRotations<Nodes>(nodes.orientation)};
  for (const auto& constants : element.stiffness_points) {
    GeneralisedShapeFunctions<Nodes> functions;
    const auto rotation = local.evaluate(constants.shape, constants.derivative, functions);
    visit(constants,
          point_kinematics(rotation, interpolate<Nodes>(constants.derivative, nodes.position),
                           constants.reference_strain),
          functions);
  }
}

/// Variation d{Gamma, K} at a point, by {displacement, spin} of the nodes.
template <int Nodes>
Eigen::MatrixXd strain_variation(const PointKinematics& point, const NodalValues<Nodes>& derivative,
                                 const GeneralisedShapeFunctions<Nodes>& spins) {
  const Matrix3& rotation = point.rotation;
  const Matrix3 turned = rotation.transpose() * so3::hat(point.tangent);
  Eigen::MatrixXd variation(6, 6 * Nodes);
  for (int i = 0; i < Nodes; ++i)
    variation.middleCols<6>(6 * i) << derivative[i] * rotation.transpose(), turned * spins.values[i], Matrix3::Zero(),
        rotation.transpose() * spins.derivatives[i];
  return variation;
}

}  // namespace

template <int Nodes>
Eigen::MatrixXd material_stiffness(const BeamElement<Nodes>& element, const State& state) {
  Eigen::Matrix<double, 6 * Nodes, 6 * Nodes> stiffness = Eigen::Matrix<double, 6 * Nodes, 6 * Nodes>::Zero();
  for_each_point(element, state, [&](const auto& constants, const PointKinematics& point, const auto& functions) {
    const endpoint::PointTangent tangent =
        endpoint::point_tangent(point, constants.stiffness, 1, Vector3::Zero(), Vector3::Zero());
    add_point_tangent<Nodes>(constants.weight, LagrangeTests<Nodes>{constants.shape, constants.derivative},
                             {constants.derivative, functions}, tangent.resultants, tangent.couple, stiffness);
  });
  return stiffness;
}

template <int Nodes>
Eigen::MatrixXd material_curvature(const BeamElement<Nodes>& element, const State& state) {
  Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(6 * Nodes, 6 * Nodes);
  for_each_point(element, state, [&](const auto& constants, const PointKinematics& point, const auto& spins) {
    const Eigen::MatrixXd strains = strain_variation<Nodes>(point, constants.derivative, spins);
    const Eigen::MatrixXd stresses = (constants.weight * strains.transpose()).lazyProduct(constants.stiffness);
    curvature += stresses.lazyProduct(strains);
  });
  return curvature;
}

template <int Nodes>
std::vector<Eigen::MatrixXd> strain_variations(const BeamElement<Nodes>& element, const State& state) {
  std::vector<Eigen::MatrixXd> variations;
  for_each_point(element, state, [&](const auto& constants, const PointKinematics& point, const auto& spins) {
    variations.push_back(strain_variation<Nodes>(point, constants.derivative, spins));
  });
  return variations;
}

// Compiled here once for each order of elements.
#define COMPILE_FOR(Nodes)                                                \
  template decltype(material_stiffness<Nodes>) material_stiffness<Nodes>; \
  template decltype(strain_variations<Nodes>) strain_variations<Nodes>;   \
  template decltype(material_curvature<Nodes>) material_curvature<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
