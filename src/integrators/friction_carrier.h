#pragma once
/// Set-valued friction of the coordinates that share one unknown.

#include <vector>

#include "joints/dry_friction.h"

namespace flexarm {

/// A coordinate that follows no other one, with those that follow it and have set-valued friction: all move or stick
/// together, and its row carries what all of them dissipate.
struct FrictionCarrier {
  int coordinate = -1;
  StickSlip law;
  std::vector<int> members;                          ///< coordinates with friction, itself perhaps among them
  double increment = 0, reaction = 0, capacity = 0;  ///< at the last evaluation; the latter two against the increment
};

}  // namespace flexarm
