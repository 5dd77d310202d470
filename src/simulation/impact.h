#pragma once
/// The impact when two links are joined to one body while they move.

#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// Returns the state after the impulses i of a joint that holds two frames in their present relative pose. Of all
/// velocities with which the two links move as one, v+ is the nearest to the velocity v- before, measured by kinetic
/// energy: M (v+ - v-) = B^T i, B v+ = 0. The momenta of a floating mechanism are conserved, and the energy
/// 1/2 (v- - v+) . M (v- - v+) is lost. (docs/payloads.md)
/// @throws std::invalid_argument if there are no such velocities because motions are prescribed.
State after_impact(const Model& model, const Scheme& scheme, const State& state, const Attachment& parent,
                   const Attachment& child);

}  // namespace flexarm
