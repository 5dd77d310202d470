#pragma once
/// Loops closed over flexible links that stand at a dead point.

#include <string>

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Name of the link that is strained most where links, unloaded, are free to move to first order and no further: their
/// loop may go on in more than one way, which small disturbances decide. Empty: there is none, or what beams there are
/// resists in first order. `contact_time`: of stops (Scheme::contact_time) [s].
/// @throws std::runtime_error if the stiffness is not finite.
std::string link_at_dead_point(const Model& model, const State& start, double contact_time);

}  // namespace flexarm
