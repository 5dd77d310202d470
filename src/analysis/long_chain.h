#pragma once
/// Stability of mechanisms with so many joints that their tangent matrix would be too large.

#include "analysis/stability.h"

namespace flexarm {

/// Finds a motion out of an equilibrium in which the potential falls: by the signs of Ritz values in a Krylov space of
/// K^-1, with the elimination along the tree for K. Whatever it finds is such a motion. But among many other motions,
/// it may miss one that falls steeply. Only for models without loop constraints.
/// @throws std::runtime_error if the stiffness is not finite.
UnstableMotion falling_motion(const Model& model, const State& equilibrium);

}  // namespace flexarm
