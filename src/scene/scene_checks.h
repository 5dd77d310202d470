#pragma once
/// What only the scene as a whole can show: whether its names refer to something, once, and its joints form a tree.

#include <set>
#include <string>

#include "flexarm/scene/scene_description.h"
#include "scene/findings.h"

namespace flexarm::scene {

/// Checks links and joints and sets `scene.root_link`.
void check_tree(SceneDescription& scene, Findings& findings);

/// Checks mimicking joints and the names in <simulation>. Coordinates of `unreadable` joints are not judged.
void check_references(const SceneDescription& scene, const std::set<std::string>& unreadable, Findings& findings);

}  // namespace flexarm::scene
