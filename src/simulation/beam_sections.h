#pragma once
/// Values at points of a beam, computed from its elements.

#include <array>

#include "math/quadrature.h"
#include "model/model.h"

namespace flexarm {

/// Calls `visit` with an element of a beam. `index` counts the beam's elements along its line.
template <class Visit>
void visit_element(const Model& model, const BeamLink& beam, int index, const Visit& visit) {
  for_each_group(model.beams, [&](const auto& group) {
    using Element = typename std::decay_t<decltype(group.elements)>::value_type;
    if (Element::kNodes == beam.order + 1) visit(group.elements[beam.elements[index]]);
  });
}

/// Weights by which values at the stiffness points, where stress is most accurate, give the value at xi of the
/// polynomial through them.
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
