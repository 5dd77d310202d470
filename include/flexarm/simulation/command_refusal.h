#pragma once
/// Why a joint's coordinate takes no commands.

#include <cstddef>
#include <string>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// One sentence without its end: that it mimics a joint, follows another coordinate, or that its motion is prescribed.
/// Empty: it takes efforts.
std::string refusal_of_commands(const Simulation& simulation, std::size_t coordinate);

/// The same of set points: empty where it has a servo.
std::string refusal_of_set_points(const Simulation& simulation, std::size_t coordinate);

}  // namespace flexarm
