#pragma once
/// Set-valued dry friction of coordinates that share one unknown.

#include <vector>

#include "joints/dry_friction.h"

namespace flexarm {

/// A coordinate that does not follow another one, together with its followers that have set-valued friction. They stick
/// or move together, and the row of the first coordinate contains the friction of all.
struct FrictionCarrier {
  int coordinate = -1;
  StickSlip law;
  std::vector<int> members;                          ///< coordinates with friction; may include `coordinate`
  double increment = 0, reaction = 0, capacity = 0;  ///< at the last evaluation; efforts act against the increment
};

}  // namespace flexarm
