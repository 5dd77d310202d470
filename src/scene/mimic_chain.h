#pragma once
/// Joints that mimic others, followed to the end of their chains.

#include <set>

#include "flexarm/scene/scene_description.h"
#include "scene/findings.h"

namespace flexarm::scene {

/// Records, as warnings, followers that are held since the joint at the end of their chain is fixed, and those whose
/// own limits the limits of that joint do not keep. For scenes whose mimics are good.
void check_followers(const SceneDescription& scene, Findings& findings);

/// Adds constant motions of the joints that mimic, directly or through others, a fixed joint. They keep their <mimic>,
/// which has no effect then.
void hold_followers_of_fixed_joints(SceneDescription& scene);

}  // namespace flexarm::scene
