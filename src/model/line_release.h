#pragma once
/// Changes model and state when a slider leaves its line and then moves freely.

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Returns the first slide that may leave its line (JointMap::leaving) and is beyond one of its ends; -1: none.
int slide_beyond_end(const Model& model, const State& state);

/// Returns the model after the slide `joint` has left its line. The node that slid becomes independent. A new massless
/// node at the end of the line takes its place as the joint's slave, and the joint's coordinates are kept constant.
/// Indices of nodes, joints and coordinates do not change; the new node is the last one.
Model model_after_release(Model model, const State& state, int joint);

/// Returns the state for the model after the release. `model`: the model before it. Everything with mass keeps its
/// position and velocity, and so do energy and momenta.
State state_after_release(const Model& model, State state, int joint);

}  // namespace flexarm
