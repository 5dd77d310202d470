#include "integrators/balance.h"

#include "elements/beam_point.h"
#include "elements/orders.h"

namespace flexarm {

template <int Nodes>
void Balance::add(const BeamElement<Nodes>& element, const ElementSystem<Nodes>& system, bool is_first) {
  const bool sets = is_first && tangent && tangent->keeps_elements_apart();
  dissipated += system.dissipated;
  for (int i = 0; i < Nodes; ++i) {
    residual.node(element.nodes[i]) += system.residual.template segment<6>(6 * i);
    if (carried) carried->node(element.nodes[i]) += system.carried.template segment<6>(6 * i);
    for (int j = 0; j < Nodes && tangent; ++j) {
      Eigen::Map<Matrix6> block(tangent->element_block(element.first_block + i * Nodes + j));
      if (sets)
        block = system.tangent.template block<6, 6>(6 * i, 6 * j);
      else
        block += system.tangent.template block<6, 6>(6 * i, 6 * j);
    }
  }
}

// Instantiated here once for each order of elements.
#define COMPILE_FOR(Nodes) template void Balance::add(const BeamElement<Nodes>&, const ElementSystem<Nodes>&, bool);
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
