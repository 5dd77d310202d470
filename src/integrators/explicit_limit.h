#pragma once
/// The longest step of an explicit scheme with which motions do not grow. (docs/notes/explicit.md 7)

#include <limits>

#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

struct ExplicitLimit {
  int coordinate = -1;     ///< the one that limits the step most: index into Model::coordinates; -1: none does
  const char* cause = "";  ///< what acts there: "damping", "spring", "servo", "gear", "stop"
  double step = std::numeric_limits<double>::infinity();  ///< [s]
};

/// Estimates the longest step from the stiffness and the damping of joints, servos, gears and stops, and from what
/// moves at this state. Smooth friction does not count: its effort is bounded, so that it makes a joint shake, but not
/// its motion grow. The scheme must be explicit, and suit the model. `step`: the present one [s]. Allocates memory.
ExplicitLimit explicit_limit(const Model& model, const Scheme& scheme, const State& state, double step);

}  // namespace flexarm
