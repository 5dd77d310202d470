#pragma once
/// Loops of rigid links that start where they may go on in more than one way (internal to building/).

#include <string>

#include "building/closure_jacobian.h"

namespace flexarm {

/// Name of a joint that closes a loop which starts at a dead point; empty if there is none. `jacobian`: of all
/// constraints, in the columns of what is free to move. Loops that beams take part in are not judged: they give way.
std::string loop_at_dead_point(const Model& model, const DegreesOfFreedom& dof, const ConstraintRows& jacobian);

}  // namespace flexarm
