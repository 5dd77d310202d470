#pragma once
/// Makes rigid bodies of beams without elements, before positions are known (internal to building/).

#include <optional>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm {

/// The line of a link whose beam is rigid, for output: sections in the link's frame.
struct RigidLine {
  std::vector<double> arc_lengths;  ///< [m]
  std::vector<Pose> sections;
  double mass = 0, radius = 0;
};

/// A scene whose beams all have elements.
struct RigidLines {
  /// A link whose beam has none becomes a rigid one. Its mass, centre of mass and inertia are those of elements="auto"
  /// by the quadrature of the elements, hubs included; of what is distributed along its line it takes the resultants.
  /// @throws ModelError where something needs the link to be flexible.
  explicit RigidLines(const scene::SceneDescription& original);

  scene::SceneDescription scene;
  std::vector<std::optional<RigidLine>> lines;  ///< per link; empty for those that had elements, or no beam
};

}  // namespace flexarm
