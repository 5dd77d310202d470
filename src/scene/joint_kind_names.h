#pragma once
/// Names of the kinds of joints.

#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

/// The name of a kind, as in URDF or flexarm's extension of it: "revolute", "rack_and_pinion".
const char* name_of(JointKind kind);

}  // namespace flexarm::scene
