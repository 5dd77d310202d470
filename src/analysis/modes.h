#pragma once
/// Modes of small motion about an equilibrium.

#include <vector>

#include "flexarm/model/results.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// The first `count` modes of (lambda^2 M + lambda D + K) phi = 0 about the configuration of `state`, at rest, under
/// the loads at time 0: the growing ones first, then by |lambda|. K is the tangent of the static residual, M the
/// consistent mass, and D the damping of beams, joints and touched stops (not friction), in the unknowns of the
/// mechanism. Under follower loads K is unsymmetric, and is used as it is.
///
/// Without damping, each motion gives one mode; for a divergence, it is the growing one of two. With damping, a motion
/// that does not oscillate gives two modes.
/// @throws std::runtime_error if the problem cannot be solved.
std::vector<Mode> natural_modes(const Model& model, const State& state, int count);

}  // namespace flexarm
