#pragma once
/// The origin of positions, which moves along with a mechanism that hangs on nothing.

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// A mechanism that is so many times as far from an origin as it is large has an origin of its own.
constexpr double kFarInSizes = 100;

/// Of positions in a state, in the world [m].
inline Vector3 world_origin(const Model& model, const State& state) {
  return model.origin + state.origin;
}
/// That of state.origin in a released translation of `joint`, in its frame [m].
Vector3 carried_translation(const JointMap& joint, const State& state);
/// Takes the origin along where a mechanism whose Model::floats has gone far from it. No digit of a position is lost.
void carry_origin(const Model& model, State& state);

}  // namespace flexarm
