#pragma once
/// Whether the places that a scene gives fit each other at the start: gaps of loops, links far away from their beam.

#include "flexarm/scene/diagnostic.h"
#include "flexarm/scene/scene_description.h"
#include "model/model.h"

namespace flexarm {

/// Largest gap of a loop, relative to the extent of the mechanism, that counts as rounding of a CAD system. The joint's
/// place on the child is moved by it. A larger gap is an error.
constexpr double kLargestGap = 1e-4;

/// Distance between the places of a loop joint on both links [m]. `parent`, `child`: poses of the links' frames.
double loop_gap(const scene::JointDescription& joint, const Pose& parent, const Pose& child);

/// A warning for each loop whose gap at the start is more than round-off.
scene::Diagnostics open_loops(const scene::SceneDescription& scene, const Model& model);

/// A warning for each joint whose place on a beam is far beyond an end of its line, so that a rigid offset as long as
/// a considerable part of the line connects them.
scene::Diagnostics joints_beyond_beams(const scene::SceneDescription& scene);

}  // namespace flexarm
