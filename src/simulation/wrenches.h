#pragma once
/// Wrenches that are applied to links, and forces and moments with their places, for displays.

#include <vector>

#include "flexarm/model/results.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"
#include "simulation/published_motion.h"

namespace flexarm {

/// On a rigid link at the point, on a flexible one carried by the section of the node that is nearest in the undeformed
/// link.
/// @throws std::invalid_argument if it is not finite, or its link is fixed to the world; std::out_of_range if there is
///   no such link.
NodalLoad placed_wrench(const Model& model, const AppliedWrench& wrench);

/// @throws std::invalid_argument if one of them pulls and the scheme is one that interpolates forces in time.
void require_no_pulls(const Scheme& scheme, const std::vector<NodalLoad>& wrenches);

// ---------------------------------------------------------------- as displays show them

/// Per coordinate, what an effort of one does upon the joint's slave, at the origin of the moved joint frame, about the
/// origin of the state. Replaces `wrenches`.
void effort_wrenches(const Model& model, const State& state, std::vector<ActingWrench>& wrenches);

/// As Simulation::outside_wrenches().
void outside_wrenches(const MotionView& view, PublishedMotion& motion, std::vector<ActingWrench>& wrenches);

}  // namespace flexarm
