#pragma once
/// Events of a run.

#include <string>

namespace flexarm {

/// A stop that is touched or left, dry friction that sticks or slips.
struct RunEvent {
  double time = 0;    ///< [s]
  std::string joint;  ///< coordinate
  std::string what;   ///< "touches its stop", "leaves its stop", "sticks", "slips", "turns back", ...
  std::string doubt;  ///< why derivatives behind it are not to be trusted; empty: they are
};

}  // namespace flexarm
