#include <cassert>

#include "elements/beam_point.h"
#include "elements/orders.h"

namespace flexarm {

template <int Nodes>
ElementRotations<Nodes>::ElementRotations(const ElementNodes<Nodes>& nodes, bool with_variation) {
  if (nodes.stiffness_reference) {
    referenced_.emplace(nodes.parameters, nodes.rotation_vector);
  } else {
    local_.emplace(nodes.orientation);
    if (with_variation) variation_.emplace(*local_);
  }
}

template <int Nodes>
InterpolatedRotation<double> ElementRotations<Nodes>::evaluate(const NodalValues<Nodes>& shape,
                                                               const NodalValues<Nodes>& derivative,
                                                               const InterpolatedRotation<double>* reference,
                                                               GeneralisedShapeFunctions<Nodes>& generalised) const {
  if (variation_) return variation_->evaluate(shape, derivative, generalised);
  if (local_) return local_->evaluate(shape, derivative);
  assert(reference);
  return referenced_->evaluate(shape, derivative, *reference, generalised);
}

template <int Nodes>
void carry_strains(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes,
                   const std::array<Vector6, Nodes>& update, Vector6* strains) {
  assert(strains);
  const ElementRotations<Nodes> rotations(nodes, true);
  for (int k = 0; k < BeamElement<Nodes>::kStiffnessPoints; ++k) {
    const auto& constants = element.stiffness_points[k];
    GeneralisedShapeFunctions<Nodes> generalised;
    const auto* reference = nodes.stiffness_reference ? nodes.stiffness_reference + k : nullptr;
    const auto rotation = rotations.evaluate(constants.shape, constants.derivative, reference, generalised);
    const PointKinematics point = end_kinematics<Nodes>(constants, nodes, rotation);
    Eigen::Matrix<double, 9, 1> variation = Eigen::Matrix<double, 9, 1>::Zero();  // {dr', spin, spin'}
    for (int i = 0; i < Nodes; ++i) {
      variation.head<3>() += constants.derivative[i] * update[i].template head<3>();
      variation.segment<3>(3) += generalised.values[i] * update[i].template tail<3>();
      variation.tail<3>() += generalised.derivatives[i] * update[i].template tail<3>();
    }
    strains[k] = point.strain + strain_derivative(point) * variation;
  }
}

// Explicit instantiations for each order of elements.
#define COMPILE_FOR(Nodes)                \
  template class ElementRotations<Nodes>; \
  template decltype(carry_strains<Nodes>) carry_strains<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
