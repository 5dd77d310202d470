#pragma once
/// A state as that of another model: what has the same name is where it was, moves as it did and remembers the same.

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "flexarm/scene/scene_description.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// A flexible link of both models that has other elements in one than in the other.
std::optional<std::string> link_with_other_mesh(const Model& before, const Model& after);

/// A scene's model.
struct ModelOfScene {
  const scene::SceneDescription& scene;
  const Model& model;
};

/// `state` is one of `before`. What is new is where `after` has it start. `begin`: adds what a scheme keeps at the
/// beginning of a motion; of all that is not `touched` it goes on as it was.
/// Flexible links have the same meshes, and no slider has left its line.
State carried_state(const ModelOfScene& before, const State& state, const ModelOfScene& after,
                    const std::set<std::string>& touched, const std::function<void(State&)>& begin);

}  // namespace flexarm
