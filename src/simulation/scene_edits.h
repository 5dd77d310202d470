#pragma once
/// Edits of a scene, to add or remove links.

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

/// The joint of the tree whose child is the link; null if there is none.
JointDescription* joint_above(SceneDescription& scene, const std::string& link);
const JointDescription* joint_above(const SceneDescription& scene, const std::string& link);
/// The link, and all links that it carries by joints of the tree.
std::set<std::string> branch_of(const SceneDescription& scene, const std::string& link);

/// The element that drives or holds a coordinate of the joint, if any: "motion", "effort", "servo", "drive", "spring".
std::optional<std::string> what_drives(const SceneDescription& scene, const JointDescription& joint);
/// Removes the initial values of the joint, and the initial velocity of its child.
void forget_start(SceneDescription& scene, const JointDescription& joint);

/// Pose and velocity of a link at the start, in the world.
struct LinkStart {
  Pose pose;
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();  ///< of its origin [m/s, rad/s]
};
/// Makes the joint a floating joint on the root link. It keeps its place in the list of joints.
void let_float(SceneDescription& scene, JointDescription& joint, const LinkStart& start);

/// Keeps a border between elements of a flexible link at `place` (link frame), even if nothing else is there, by a zero
/// load.
void keep_border(SceneDescription& scene, const std::string& link, const Vector3& place);

/// Removes a link, all links that it carries, and everything that refers to these.
/// @throws std::invalid_argument if a joint that stays is a mimic of a removed one.
void take_away(SceneDescription& scene, const std::string& link);

/// Returns a copy of a force element in which `change(name)` has changed the names of its links.
template <class Change>
std::shared_ptr<ForceElementDescription> with_link_names(const ForceElementDescription& element, const Change& change) {
  return element.with_links([&](std::string link) {
    change(link);
    return LinkChange{std::move(link), Pose()};
  });
}
/// Puts `prefix` before all names in a scene, except for those of the root link and of grounds.
void rename(SceneDescription& scene, const std::string& prefix);
/// Adds another scene. The two root links become one.
/// @throws std::invalid_argument if both scenes use the same name for something else.
void merge(SceneDescription& scene, const SceneDescription& other);

}  // namespace flexarm::scene
