#pragma once
/// Turns beams without elements into rigid bodies, before positions are known (internal to building/).

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

/// A scene in which all beams have elements.
struct RigidLines {
  /// A link whose beam has no elements becomes rigid. Its mass, centre of mass and inertia are those with
  /// elements="auto", by the quadrature of the elements, including hubs. Loads that are distributed along its line
  /// become their resultants.
  /// @throws ModelError if something needs the link to be flexible.
  explicit RigidLines(const scene::SceneDescription& original);

  scene::SceneDescription scene;
  std::vector<std::optional<RigidLine>> lines;  ///< per link; empty if its beam has elements, or if it has no beam
};

}  // namespace flexarm
