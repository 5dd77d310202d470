#pragma once
/// Moves the origin of positions along with a mechanism that is not attached to the world (Model::floats), so that
/// positions keep their precision far away.

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// The origin moves if the distance of the mechanism exceeds this multiple of the mechanism's size.
constexpr double kFarInSizes = 100;

/// Returns the origin of the positions in a state, in world coordinates [m].
inline Vector3 world_origin(const Model& model, const State& state) {
  return model.origin + state.origin;
}
/// Returns state.origin in the frame of a free joint on the world: its released translation is relative to that [m].
/// Zero for other joints.
Vector3 carried_translation(const JointMap& joint, const State& state);
/// Moves the origin if Model::floats is set and the mechanism is far from it (kFarInSizes). Positions lose no digits.
void carry_origin(const Model& model, State& state);

}  // namespace flexarm
