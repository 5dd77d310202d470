#pragma once
/// Surfaces of the shapes of links, as triangles.

#include <Eigen/Geometry>

#include "pictures/picture.h"
#include "pictures/surface_meshes.h"

namespace flexarm::pictures {

// Closed surfaces in the frames of the shapes. Cylinders and spheres are polyhedra whose vertices lie on them.

SurfaceMesh box_surface(const scene::BoxShape& box);
/// @param sides  of the polygon that stands for the circle
SurfaceMesh cylinder_surface(const scene::CylinderShape& cylinder, int sides);
/// @param sides  number of meridians; `bands`: between the poles
SurfaceMesh sphere_surface(const scene::SphereShape& sphere, int sides, int bands);

/// The surface of any shape, with 32 sides and 20 bands if it is round.
SurfaceMesh surface_of_shape(const PictureShape& shape, const std::vector<PictureMesh>& meshes);

/// A box around a shape, along the axes of the shape's frame.
Eigen::AlignedBox3d box_around(const PictureShape& shape, const std::vector<PictureMesh>& meshes);

}  // namespace flexarm::pictures
