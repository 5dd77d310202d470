#pragma once
/// What only the scene as a whole can show: whether its names refer to something, once, its joints form a tree, those
/// that mimic others can follow them, and its bodies can have the inertia that the file gives them.

#include <set>
#include <string>

#include "flexarm/scene/scene_description.h"
#include "scene/findings.h"

namespace flexarm::scene {

/// Checks links and joints and sets `scene.root_link`.
void check_tree(SceneDescription& scene, Findings& findings);

/// Checks mimicking joints and the names in <simulation>. Coordinates of `unreadable` joints are not judged.
void check_references(const SceneDescription& scene, const std::set<std::string>& unreadable, Findings& findings);

// ---------------------------------------------------------------- joints that mimic others (mimic_chain.cpp)

/// Records, as warnings, followers that are held since the joint at the end of their chain is fixed, and those whose
/// own limits the limits of that joint do not keep. For scenes whose mimics are good.
void check_followers(const SceneDescription& scene, Findings& findings);

/// Adds constant motions of the joints that mimic, directly or through others, a fixed joint. They keep their <mimic>,
/// which has no effect then.
void hold_followers_of_fixed_joints(SceneDescription& scene);

// ---------------------------------------------------------------- inertias (inertia_checks.cpp)

/// Principal moments of a symmetric inertia matrix, in increasing order.
Vector3 principal_moments(const Matrix3& inertia);

/// Records principal moments that no body has: negative ones are errors where something would move with them, and
/// warnings where they are negligible or made up for by the links that are fixed to the link. Beams have their own.
void check_inertias(const SceneDescription& scene, Findings& findings);

}  // namespace flexarm::scene
