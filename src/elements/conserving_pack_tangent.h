#pragma once
/// The tangent on packs, for the units that compile it.

#include "elements/conserving_pack_stages.h"
#include "elements/conserving_tangent.h"
#include "math/simd.h"

namespace flexarm::packs {

template <int Nodes>
void add_tangent(const ConservingElement<Nodes, Pack>& element, const BeamNodes<Nodes, Pack>& nodes,
                 const TimeRule& rule, const conserving::StepPoints<Nodes, Pack>& at,
                 const conserving::EnergyMultiplier<Nodes, Pack>& multiplier, BlockSystem<Nodes, Pack>& system) {
  simd::run([&] { conserving::add_tangent<Nodes, Pack>(element, nodes, rule, at, multiplier, system); });
}

}  // namespace flexarm::packs
