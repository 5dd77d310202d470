#pragma once
/// Where the mechanism starts, as far as only the whole scene can tell.

#include <optional>
#include <set>
#include <string>

#include "flexarm/scene/scene_description.h"
#include "scene/findings.h"

namespace flexarm::scene {

/// What <simulation> asks for.
struct StartRequest {
  struct Root {
    bool floats;
    SourceLocation location;
  };
  std::optional<Root> root;               ///< <root>
  bool clamps_all = false;                ///< start="clamp"
  std::set<std::string> clamped, placed;  ///< coordinates whose <initial> has position="clamp", or a number
};

/// Puts a floating root link on a joint to a new root, the world; says if one with a mass is clamped that is not named
/// so.
void settle_root(SceneDescription& scene, const StartRequest& request, Findings& findings);

/// Gives joints that are to start at their nearest limit that position, and records those that start outside their
/// limits. Joints that are `unreadable` are not judged.
void settle_positions(SceneDescription& scene, const StartRequest& request, const std::set<std::string>& unreadable,
                      Findings& findings);

}  // namespace flexarm::scene
