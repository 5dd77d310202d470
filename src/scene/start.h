#pragma once
/// Settles those parts of the initial state that require the whole scene: the root link, and positions at limits.

#include <optional>
#include <set>
#include <string>

#include "flexarm/scene/scene_description.h"
#include "scene/findings.h"

namespace flexarm::scene {

/// What <simulation> says about the initial state and the root link.
struct StartRequest {
  struct Root {
    bool floats;
    SourceLocation location;
  };
  std::optional<Root> root;               ///< <root>
  bool is_spawned = false;                ///< the model floats when it is spawned, whatever its root link
  bool clamps_all = false;                ///< start="clamp"
  std::set<std::string> clamped, placed;  ///< coordinates whose <initial> has position="clamp", or a number
};

/// If the root link floats, adds a new root link "world" and a floating joint between both. If it has a mass and is
/// clamped, warns, unless its name is "world", <root> says that it is clamped, or the model is to be spawned.
void settle_root(SceneDescription& scene, const StartRequest& request, Findings& findings);

/// Sets the initial positions of joints that are to start at their nearest limit, and warns about joints that start
/// outside their limits. `unreadable`: names of joints with errors of their own; these are not checked.
void settle_positions(SceneDescription& scene, const StartRequest& request, const std::set<std::string>& unreadable,
                      Findings& findings);

}  // namespace flexarm::scene
