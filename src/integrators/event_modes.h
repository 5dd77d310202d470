#pragma once
/// The branches of stops and dry friction that hold over a step.

#include <array>
#include <vector>

#include "joints/coordinate_step.h"
#include "joints/dry_friction.h"

namespace flexarm {

/// A run finds these branches step by step. Derivatives of the run use the same branches, so that the equations of the
/// neighbouring runs are smooth. (docs/notes/sensitivities.md 3)
struct EventModes {
  std::vector<std::array<StopContact, 2>> stops;  ///< per coordinate: below, above
  std::vector<StickSlip::Branch> friction;        ///< per carrier: SlipBack, SlipForth, or HeldLow where it sticks
};

}  // namespace flexarm
