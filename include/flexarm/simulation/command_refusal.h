#pragma once
/// Why a joint's coordinate takes no commands.

#include <cstddef>
#include <string>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// A sentence without its end: it mimics a joint, follows another coordinate, or has a prescribed motion. Empty if it
/// takes efforts.
std::string refusal_of_commands(const Simulation& simulation, std::size_t coordinate);

/// The same for set points. Empty if it has a servo.
std::string refusal_of_set_points(const Simulation& simulation, std::size_t coordinate);

}  // namespace flexarm
