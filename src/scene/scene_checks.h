#pragma once
/// Checks of a whole scene: names are unique and refer to something, joints form a tree, mimicking joints can follow
/// their masters, inertias are physically possible, and units are probably the right ones.

#include <set>
#include <string>

#include "flexarm/scene/scene_description.h"
#include "scene/findings.h"

namespace flexarm::scene {

// ---------------------------------------------------------------- the tree (tree_checks.cpp)

/// Checks links and joints and sets `scene.root_link`. Declares the link "world" with a warning if joints use it as the
/// root and nobody declares it.
void check_tree(SceneDescription& scene, Findings& findings);

// ---------------------------------------------------------------- names (scene_checks.cpp)

/// Checks mimicking joints, and all names that <simulation>, force elements and sensors refer to. `unreadable`: names
/// of links and joints with errors of their own; references to them are not checked.
void check_references(const SceneDescription& scene, const std::set<std::string>& unreadable, Findings& findings);

// ---------------------------------------------------------------- joints that mimic others (mimic_chain.cpp)

/// Warns about two kinds of followers, that is, joints that mimic others: those that cannot move since the joint at the
/// end of their chain is fixed, and those whose own limits the motion of that joint may exceed. The scene's <mimic>s
/// must have no errors.
void check_followers(const SceneDescription& scene, Findings& findings);

/// Adds a constant prescribed motion for each joint that mimics a fixed joint, directly or through others. These joints
/// keep their <mimic>, which then has no effect.
void hold_followers_of_fixed_joints(SceneDescription& scene);

// ---------------------------------------------------------------- inertias (inertia_checks.cpp)

/// Returns the principal moments of a symmetric inertia matrix, in increasing order.
Vector3 principal_moments(const Matrix3& inertia);

/// Records principal moments that no body can have. A negative one is an error if something would move with it. It is a
/// warning if it is negligible, if links fixed to this link compensate it, or if it is so small that it results from
/// rounded numbers; then the inertia becomes the nearest one whose moments are 0 or more. Links with beams are skipped,
/// since their inertia is the beam's.
void settle_inertias(SceneDescription& scene, Findings& findings);

// ---------------------------------------------------------------- units (unit_checks.cpp)

/// Warns about beams whose material or size is so unusual that it was probably given in other units: GPa or MPa,
/// g/cm^3, mm. Only sections with a shape and a material are judged.
void warn_of_units(const SceneDescription& scene, Findings& findings);

}  // namespace flexarm::scene
