#pragma once
/// Values at points of a beam, from its elements.

#include <array>

#include "math/quadrature.h"
#include "model/model.h"

namespace flexarm {

/// Visits an element of a beam by its index in the group of its order.
template <class Visit>
void visit_element(const Model& model, const BeamLink& beam, int index, const Visit& visit) {
  for_each_group(model.beams, [&](const auto& group) {
    using Element = typename std::decay_t<decltype(group.elements)>::value_type;
    if (Element::kNodes == beam.order + 1) visit(group.elements[beam.elements[index]]);
  });
}

/// Value at xi of the polynomial through the values at the stiffness points, where stress is most accurate.
template <int Nodes>
std::array<double, Nodes - 1> extension_weights(double xi) {
  const auto& abscissa = GaussLegendre<Nodes - 1>::points;
  std::array<double, Nodes - 1> weights;
  weights.fill(1);
  for (int a = 0; a < Nodes - 1; ++a)
    for (int b = 0; b < Nodes - 1; ++b)
      if (b != a) weights[a] *= (xi - abscissa[b]) / (abscissa[a] - abscissa[b]);
  return weights;
}

}  // namespace flexarm
