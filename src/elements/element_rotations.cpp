#include <cassert>

#include "elements/beam_point.h"

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

template class ElementRotations<2>;
template class ElementRotations<3>;
template class ElementRotations<4>;
template class ElementRotations<5>;

}  // namespace flexarm
