#pragma once
/// The arms that the documentation shows.

#include <string>

#include "flexarm/scene/scene_description.h"

namespace flexarm::test {

/// The second scene of docs/guide.md.
scene::SceneDescription guide_arm();
/// config/demo_arm.urdf.
scene::SceneDescription demo_arm();

}  // namespace flexarm::test
