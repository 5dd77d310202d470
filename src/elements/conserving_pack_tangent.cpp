#include "elements/conserving_pack_stages.h"
#include "elements/conserving_tangent.h"
#include "elements/orders.h"
#include "math/simd.h"

namespace flexarm::packs {

template <int Nodes>
void add_tangent(const ConservingElement<Nodes, Pack>& element, const BeamNodes<Nodes, Pack>& nodes,
                 const TimeRule& rule, const conserving::StepPoints<Nodes, Pack>& at,
                 const conserving::EnergyMultiplier<Nodes, Pack>& multiplier, BlockSystem<Nodes, Pack>& system) {
  simd::run([&] { conserving::add_tangent<Nodes, Pack>(element, nodes, rule, at, multiplier, system); });
}

// Explicit instantiations for each order of elements.
#define COMPILE_FOR(Nodes) template decltype(add_tangent<Nodes>) add_tangent<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm::packs
