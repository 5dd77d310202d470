#pragma once
/// Ends of beams on which drives act.

#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// A warning for each joint that is driven where a beam's end has hardly an inertia of its own: what a drive or a
/// controller does there moves a slice of the beam, far too fast for the step.
std::vector<std::string> warnings_of_driven_ends(const Simulation& simulation);

}  // namespace flexarm
