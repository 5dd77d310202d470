#pragma once
/// Converts a state to another model, when a scene is edited while it moves. Whatever has the same name in both models
/// keeps its position, its motion and its memory.

#include <functional>
#include <set>
#include <string>

#include "model/state.h"
#include "simulation/model_correspondence.h"

namespace flexarm {

/// Converts `state`, a state of `before`, to a state of `after`. New parts start where `after` places them. `begin`
/// adds to a state what a scheme stores at the beginning of a motion, such as accelerations. Only the trees that
/// contain a link of `touched` get these values; all other parts keep their own.
/// Requires that flexible links have the same meshes in both models, and that no slider has left its line.
State carried_state(const ModelOfScene& before, const State& state, const ModelOfScene& after,
                    const std::set<std::string>& touched, const std::function<void(State&)>& begin);

}  // namespace flexarm
