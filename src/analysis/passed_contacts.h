#pragma once
/// Bodies that a step of a search for an equilibrium takes through each other.

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Whether bodies that may touch pass through each other, or through the thickness of a beam, if all nodes go straight
/// from one state to another. Steps towards an equilibrium are long, and without this check a body would jump through
/// the beam on which it should come to rest.
bool pass_through(const Model& model, const State& from, const State& to);

}  // namespace flexarm
