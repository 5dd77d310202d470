#pragma once
/// The branches of laws with corners that hold over a step.

#include <array>
#include <vector>

#include "joints/coordinate_step.h"
#include "joints/dry_friction.h"

namespace flexarm {

/// A run finds them step by step. Derivatives of a run hold those that the run has, so that its neighbours go by
/// equations that are smooth. (docs/notes/sensitivities.md 3)
struct EventModes {
  std::vector<std::array<StopContact, 2>> stops;  ///< per coordinate: below, above
  std::vector<StickSlip::Branch> friction;        ///< per carrier: SlipBack, SlipForth, or HeldLow where it sticks
};

}  // namespace flexarm
