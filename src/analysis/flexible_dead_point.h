#pragma once
/// Dead points of loops that are closed over flexible links.

#include <string>

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// If links can move freely to first order, but not to second order, returns the name of the link that is strained
/// most; loads do not count. The loop may then go on in more than one way, and small disturbances decide which. Empty
/// if there is no such link, or if beams resist in first order.
/// @throws std::runtime_error if the stiffness is not finite.
std::string link_at_dead_point(const Model& model, const State& start);

}  // namespace flexarm
