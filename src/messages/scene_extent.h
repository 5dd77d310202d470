#pragma once
/// Where the scene lies, and how far it reaches: for displays.

#include "flexarm/simulation/simulation.h"

namespace flexarm::messages {

struct SceneExtent {
  Vector3 center;  ///< in the world [m]
  double radius;   ///< of a sphere around all of it [m]; 1 for a scene without any extent
};

/// A sphere around all places that the scene reaches, in the present configuration and by its joints: what turns
/// reaches as far as it is long, what slides as far as its limits. Link frames, centres of mass and centrelines count,
/// shapes for display do not. Bodies that float are where they are now, and beams as long and as bent as now.
SceneExtent scene_extent(const Simulation& simulation);

/// The picture that rviz shows of that sphere at the start (config/flexarm.rviz), as unit vectors in the world.
struct PictureAxes {
  Vector3 right, up, to_camera;
};
PictureAxes picture_axes();
/// By which the sphere's outline is larger than its radius, where the camera is as far away as scripts/show_in_rviz.py
/// puts it: what is drawn beyond, in the plane of the sphere's centre across the camera's view, neither covers the arm
/// nor is covered.
constexpr double kOutline = 1.042;

}  // namespace flexarm::messages
