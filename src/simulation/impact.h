#pragma once
/// Two links become one body while they move.

#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// The state after the impulses of a joint that holds two frames to each other as they stand: of all velocities with
/// which they move as one the nearest in kinetic energy, M (v+ - v-) = B^T i, B v+ = 0. Momenta of what floats stay,
/// and 1/2 (v- - v+) . M (v- - v+) of the energy is lost. (docs/payloads.md)
/// @throws std::invalid_argument where no velocities do that, since motions are prescribed.
State after_impact(const Model& model, const Scheme& scheme, const State& state, const Attachment& parent,
                   const Attachment& child);

}  // namespace flexarm
