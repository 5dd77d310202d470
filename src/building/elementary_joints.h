#pragma once
/// The elementary joints of which the joints of the scene consist (internal to building/).

#include <string>
#include <vector>

#include "flexarm/scene/scene_description.h"
#include "model/joint.h"

namespace flexarm {

/// The chain of elementary joints that makes up a joint. Empty for a fixed joint, and for a slide without its rotation.
std::vector<JointMap> elementary_joints(const scene::JointDescription& joint);
/// Names of a joint's coordinates, in the order of its chain.
std::vector<std::string> coordinate_names(const scene::JointDescription& joint);

}  // namespace flexarm
