#pragma once
/// Forces and moments as displays show them: with their places.

#include <vector>

#include "flexarm/model/results.h"
#include "simulation/motion_view.h"
#include "simulation/published_motion.h"

namespace flexarm {

/// Per coordinate, what an effort of one does upon the joint's slave, at the origin of the moved joint frame, about the
/// origin of the state. Replaces `wrenches`.
void effort_wrenches(const Model& model, const State& state, std::vector<ActingWrench>& wrenches);

/// As Simulation::outside_wrenches().
void outside_wrenches(const MotionView& view, PublishedMotion& motion, std::vector<ActingWrench>& wrenches);

}  // namespace flexarm
