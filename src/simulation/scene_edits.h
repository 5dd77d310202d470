#pragma once
/// Changes of a scene to which links are added, or from which they are taken.

#include <optional>
#include <set>
#include <string>

#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

/// The joint of the tree that carries a link; null: none does.
JointDescription* joint_above(SceneDescription& scene, const std::string& link);
const JointDescription* joint_above(const SceneDescription& scene, const std::string& link);
/// The link, and all that it carries by joints of the tree.
std::set<std::string> branch_of(const SceneDescription& scene, const std::string& link);

/// The element that drives or holds a coordinate of the joint: "motion", "effort", "servo", "drive", "spring".
std::optional<std::string> what_drives(const SceneDescription& scene, const JointDescription& joint);
/// Takes away where the joint starts, and how its child moves then.
void forget_start(SceneDescription& scene, const JointDescription& joint);

/// How a link starts, in the world.
struct LinkStart {
  Pose pose;
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();  ///< of its origin [m/s, rad/s]
};
/// Makes the joint, which stays in its place among the others, a floating one on the root link.
void let_float(SceneDescription& scene, JointDescription& joint, const LinkStart& start);

/// Lets a flexible link have a border between elements at the same place (link frame) when nothing else is there.
void keep_border(SceneDescription& scene, const std::string& link, const Vector3& place);

/// Takes away a link, all that it carries, and all that speaks of these.
/// @throws std::invalid_argument where a joint that stays follows one that goes.
void take_away(SceneDescription& scene, const std::string& link);

/// Puts `prefix` before the names of what a scene describes.
/// @throws std::invalid_argument where it has force elements, whose names cannot be changed.
void rename(SceneDescription& scene, const std::string& prefix);
/// Adds another scene, whose root link is this one's. @throws std::invalid_argument where both have the same name.
void merge(SceneDescription& scene, const SceneDescription& other);

}  // namespace flexarm::scene
