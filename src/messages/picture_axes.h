#pragma once
/// How rviz's camera sees a scene at the start.

#include "flexarm/math/pose.h"

namespace flexarm::messages {

/// Axes of rviz's picture of the sphere around a scene (pictures/scene_extent.h) at the start
/// (config/flexarm.rviz), as unit vectors in the world.
struct PictureAxes {
  Vector3 right, up, to_camera;
};
PictureAxes picture_axes();
/// Radius of the sphere's outline in the picture, per radius of the sphere, if the camera is as far away as
/// scripts/show_in_rviz.py puts it. A drawing farther from the centre, in the plane through the sphere's centre normal
/// to the camera's view, neither covers the arm nor is covered by it.
constexpr double kOutline = 1.042;

}  // namespace flexarm::messages
