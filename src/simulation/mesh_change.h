#pragma once
/// Converts a state to a model of the same scene in which elements were halved, or halves joined again.
/// (docs/notes/refinement.md)

#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// Returns the state of `after` that continues `state`, a state of `before`. The models may differ by one level: an
/// element of one is the same, or consists of two elements of the other. The ends of elements that were halved or
/// joined keep their positions; their other nodes are placed where the strain energy is least. What slides there stays
/// on the line. Linear and angular momentum are the same up to round-off. The change of energy counts in the account.
State on_changed_mesh(const Model& before, const State& state, const Model& after, const Scheme& scheme);

/// Returns the state with lists of the sizes that belong to the model, which may have another mesh. Their contents are
/// meaningless.
State sized_for(const Model& model, State state);

}  // namespace flexarm
