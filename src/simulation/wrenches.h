#pragma once
/// Converts wrenches on links to loads on nodes. Lists forces and moments with their places, for displays.

#include <vector>

#include "flexarm/model/results.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"
#include "simulation/published_motion.h"

namespace flexarm {

/// Converts a wrench to a load on a node. On a flexible link, the point is carried by the section of the node that is
/// nearest to it in the undeformed link.
/// @throws std::invalid_argument if the wrench is not finite, or its link is fixed to the world; std::out_of_range if
/// there is no such link.
NodalLoad placed_wrench(const Model& model, const AppliedWrench& wrench);

/// @throws std::invalid_argument if a wrench pulls and the scheme interpolates forces in time.
void require_no_pulls(const Scheme& scheme, const std::vector<NodalLoad>& wrenches);

// ---------------------------------------------------------------- for displays

/// For each coordinate, the wrench of a unit effort on the joint's slave, at the origin of the moved joint frame. Its
/// position is relative to the state's origin. Replaces `wrenches`.
void effort_wrenches(const Model& model, const State& state, std::vector<ActingWrench>& wrenches);

/// As Simulation::outside_wrenches().
void outside_wrenches(const MotionView& view, PublishedMotion& motion, std::vector<ActingWrench>& wrenches);

}  // namespace flexarm
