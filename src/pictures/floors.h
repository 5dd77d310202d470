#pragma once
/// Planes with a grid, on which a scene stands in pictures.

#include <vector>

#include "flexarm/scene/contact_description.h"
#include "pictures/scene_extent.h"

namespace flexarm::pictures {

/// A rectangle in a plane, whose edges and grid lines are along its axes x and y; z points away from what is below.
struct Floor {
  Pose pose;              ///< of its centre
  double length, width;   ///< along x and y, multiples of the distance of grid lines [m]
  double cell;            ///< distance of grid lines [m]
  bool is_ground = true;  ///< else only the grid is drawn
};

/// One floor for each ground, as large as the extent's shadow on it and a margin. Without grounds, a grid through the
/// world's origin, across `up`. Grid lines go through the point of the plane that is nearest to the world's origin.
/// @param up  unit vector
std::vector<Floor> floors_of(const std::vector<scene::GroundDescription>& grounds, const Vector3& up,
                             const SceneExtent& extent);

/// Against gravity, or z without gravity.
Vector3 up_of(const Vector3& gravity);

}  // namespace flexarm::pictures
