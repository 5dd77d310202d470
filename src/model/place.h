#pragma once
/// Finds out which part of the scene an element, node, joint or loop of the model belongs to, for messages. These
/// functions search, so use them rarely.

#include "flexarm/model/results.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Returns the place of an element. `index`: in the group of its order; `node`: gives the position.
StepResult::Place place_of_element(const Model& model, const State& state, int order, int index, int node);
/// Returns the place of the first element that has the node, or else of the rigid link that is fixed to it.
StepResult::Place place_of_node(const Model& model, const State& state, int node);
/// Returns the place of the joint's slave, and the coordinate, if the joint has one with this component.
StepResult::Place place_of_joint(const Model& model, const State& state, int joint, int component = 0);
StepResult::Place place_of_loop(const Model& model, const State& state, int loop);
/// Returns the place of the first node on which the force element acts.
StepResult::Place place_of_force_element(const Model& model, const State& state, int element);

}  // namespace flexarm
