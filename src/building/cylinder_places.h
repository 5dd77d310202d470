#pragma once
/// Gives the parts of cylinders their places (internal to building/).

#include "flexarm/scene/diagnostic.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm {

/// A scene without cylinders whose parts have no places.
struct PlacedScene {
  scene::SceneDescription scene;
  scene::Diagnostics warnings;
};

/// Places the parts of all cylinders: between the points of both links, as the other joints place these at the start.
/// The barrel's x axis points from the first point to the second one. The first axis of the hinge, z, is that axis of
/// the joints between both links that is most nearly normal to the line. So the hinge of a plane mechanism never locks.
/// Parts get shapes for display.
/// @throws ModelError if the points of a cylinder coincide, or if a motion begins with another length.
PlacedScene place_cylinders(const scene::SceneDescription& scene);

}  // namespace flexarm
