#pragma once
/// Stages of a pack's step that conserving_pack_forces.cpp calls. Each is compiled in a unit of its own, since
/// compilers need too much memory otherwise.

#include "elements/conserving_beam.h"
#include "elements/conserving_element.h"
#include "schemes/time_rule.h"

namespace flexarm::packs {

template <int Nodes>
void set_points(const ConservingElement<Nodes, Pack>& element, const BeamNodes<Nodes, Pack>& nodes,
                const TimeRule& rule, const ElementFunctions<Nodes, Pack>& functions, bool with_variation,
                PointKinematicsT<Pack>* end, conserving::StepPoints<Nodes, Pack>& at);

template <int Nodes>
void add_tangent(const ConservingElement<Nodes, Pack>& element, const BeamNodes<Nodes, Pack>& nodes,
                 const TimeRule& rule, const conserving::StepPoints<Nodes, Pack>& at,
                 const conserving::EnergyMultiplier<Nodes, Pack>& multiplier, BlockSystem<Nodes, Pack>& system);

}  // namespace flexarm::packs
