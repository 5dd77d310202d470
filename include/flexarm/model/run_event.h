#pragma once
/// Events of a run at which forces or velocities jump.

#include <string>

namespace flexarm {

/// An event of a joint coordinate: a stop is touched or left, or dry friction sticks or slips.
struct RunEvent {
  double time = 0;    ///< [s]
  std::string joint;  ///< name of the coordinate
  std::string what;   ///< "touches its stop", "leaves its stop", "sticks", "slips", "turns back", ...
  std::string doubt;  ///< why derivatives after this event may be wrong; empty if they are reliable
};

}  // namespace flexarm
