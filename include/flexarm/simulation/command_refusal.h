#pragma once
/// Explains why a joint coordinate accepts no commands.

#include <cstddef>
#include <string>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Why the coordinate accepts no efforts, as a clause for a message: it mimics a joint, follows another coordinate, or
/// has a prescribed motion. Empty if it accepts efforts.
std::string refusal_of_commands(const Simulation& simulation, std::size_t coordinate);

/// Why the coordinate accepts no set points, likewise. Empty if it has a servo.
std::string refusal_of_set_points(const Simulation& simulation, std::size_t coordinate);

/// Says, as a clause for a message, that there is no joint coordinate of that name, and which ones there are, the
/// nearest name first.
std::string unknown_coordinate(const Simulation& simulation, const std::string& name);

}  // namespace flexarm
