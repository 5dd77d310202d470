#pragma once
/// Natural modes about an equilibrium.

#include <vector>

#include "flexarm/model/model.h"
#include "flexarm/model/state.h"

namespace flexarm {

struct Mode {
  double frequency = 0;              ///< [Hz]; 0 for a rigid motion; negative: grows as exp(2 pi |frequency| t)
  std::vector<Vector6> node_motion;  ///< {displacement, spin} of every node, largest component 1
};

/// The `count` lowest modes of K phi = omega^2 M phi about the configuration of `state`, at rest, under the loads at
/// time 0. K is the tangent of the static residual, M the consistent mass, both in the unknowns of the mechanism. K is
/// unsymmetric away from straight configurations; frequencies come from the unsymmetric problem as it is.
/// @throws std::runtime_error if the problem cannot be solved.
std::vector<Mode> natural_modes(const Model& model, const State& state, int count);

}  // namespace flexarm
