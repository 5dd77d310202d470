#pragma once
/// Is an equilibrium stable?

#include <string>

#include <Eigen/Core>

#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// A motion of the unknowns in which the potential falls.
struct UnstableMotion {
  Eigen::VectorXd direction;  ///< one entry per unknown; the farthest node moves by the length scale or turns by 1 rad
  double curvature = 0;       ///< of the potential, less than zero, beside that of Drag with strength 1 [J]
  std::string link;           ///< that moves most; empty: there is no such motion
};

struct Stability {
  UnstableMotion motion;
  std::string loose_link;  ///< that neither strains nor loads hold, so that it may stand elsewhere; empty: none
  bool is_stable() const { return motion.link.empty(); }
};

/// Curvature of the potential that counts as none, beside that of Drag with strength 1: a millionth of what weight and
/// loads do over the length scale, since equilibria are found up to a tolerance [J].
double neutral_curvature(const Model& model, const State& equilibrium);

/// Decides by the signs of the pivots of the tangent's symmetric part, in motions that loops allow (Sylvester's law of
/// inertia); for chains of more than a thousand joints by falling_motion(). The potential is always that of local
/// interpolation in the same configuration: interpolations whose strains depend on the past have no potential, and
/// differ by the elements' error. Not judged, and taken as stable, are loads without a potential, for which there is
/// natural_modes(), and such long chains in loops that multipliers close.
/// @throws std::runtime_error if the stiffness is not finite.
Stability judge_stability(const Model& model, const Scheme& scheme, const State& equilibrium);

}  // namespace flexarm
