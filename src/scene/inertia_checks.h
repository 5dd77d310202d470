#pragma once
/// Whether bodies can have the inertia that the file gives them.

#include "flexarm/scene/scene_description.h"
#include "scene/findings.h"

namespace flexarm::scene {

/// Principal moments of a symmetric inertia matrix, in increasing order.
Vector3 principal_moments(const Matrix3& inertia);

/// Records principal moments that no body has: negative ones are errors where something would move with them, and
/// warnings where they are negligible or made up for by the links that are fixed to the link. Beams have their own.
void check_inertias(const SceneDescription& scene, Findings& findings);

}  // namespace flexarm::scene
