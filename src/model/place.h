#pragma once
/// The names by which a user knows parts of a model. These functions search, so use them rarely.

#include "flexarm/model/results.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Of an element, by its index in the group of its order; where `node` is.
StepResult::Place place_of_element(const Model& model, const State& state, int order, int index, int node);
/// The first element that has the node, or the rigid link that is fixed to it.
StepResult::Place place_of_node(const Model& model, const State& state, int node);
/// The coordinate; where the joint has none, what it holds.
StepResult::Place place_of_joint(const Model& model, const State& state, int joint, int component = 0);
StepResult::Place place_of_loop(const Model& model, const State& state, int loop);

}  // namespace flexarm
