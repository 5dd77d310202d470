#pragma once
/// Judges the stability of an equilibrium.

#include <string>

#include <Eigen/Core>

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// A motion of the unknowns in which the potential falls.
struct UnstableMotion {
  Eigen::VectorXd direction;  ///< one entry per unknown; the farthest node moves by the length scale or turns by 1 rad
  double curvature = 0;       ///< of the potential, less than zero, relative to that of Drag with strength 1 [J]
  std::string link;           ///< the link that moves most; empty: there is no such motion
};

struct Stability {
  UnstableMotion motion;
  std::string loose_link;  ///< a link that neither strains nor loads hold, so that it may stand elsewhere; empty: none
  bool is_stable() const { return motion.link.empty(); }
};

/// Curvature of the potential that counts as zero, relative to that of Drag with strength 1 [J]. It is a millionth of
/// the work of weight and loads over the length scale, since equilibria are found up to a tolerance.
double neutral_curvature(const Model& model, const State& equilibrium);

/// Decides by the signs of the pivots of the tangent's symmetric part (Sylvester's law of inertia), in motions that
/// loops allow. Chains of more than a thousand joints are judged by falling_motion(). The potential is always that of
/// local interpolation in the same configuration. Interpolations whose strains depend on the past have no potential,
/// and differ by the elements' error. Two cases are not judged, and count as stable: loads without a potential, for
/// which there is natural_modes(), and such long chains with loops that multipliers close.
/// @throws std::runtime_error if the stiffness is not finite.
Stability judge_stability(const Model& model, const State& equilibrium);

}  // namespace flexarm
