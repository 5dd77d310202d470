#pragma once
/// Stability of mechanisms whose tangent matrix would be too large.

#include "analysis/stability.h"

namespace flexarm {

/// A motion of an equilibrium in which the potential falls, by the signs of what a Krylov space of K^-1 sees (Ritz
/// values), with the elimination along the tree for K. Whatever it finds is one; a motion that falls steeply, beside
/// many others, may be missed. Of models without loops' constraints.
/// @throws std::runtime_error if the stiffness is not finite.
UnstableMotion falling_motion(const Model& model, const Scheme& scheme, const State& equilibrium);

}  // namespace flexarm
