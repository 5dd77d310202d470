#include "study_schemes/element_nodes.h"

#include <cassert>

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
  carried_strains<Nodes>(element, nodes, stiffness_rotations(element, nodes, rotations), update, strains);
}

// Explicit instantiations for each order of elements.
#define COMPILE_FOR(Nodes)                \
  template class ElementRotations<Nodes>; \
  template decltype(carry_strains<Nodes>) carry_strains<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
