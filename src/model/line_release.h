#pragma once
/// A slider that leaves its line and then flies freely.

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// The first slide that may leave its line (JointMap::leaving) and is beyond one of the ends; -1: none.
int slide_beyond_end(const Model& model, const State& state);

/// The model after the slide `joint` has left its line: the node that slid is independent, and a massless one at the
/// line's end has taken its place in the joint, whose coordinates stay what they are. Indices of nodes, joints and
/// coordinates are unchanged; there is one node more, at the end.
Model model_after_release(Model model, const State& state, int joint);

/// The state that belongs to it. All that has mass keeps place and velocity, hence energy and momenta.
State state_after_release(const Model& model, State state, int joint);

}  // namespace flexarm
