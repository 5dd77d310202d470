#pragma once
/// Shapes of a link: URDF's <visual> and <collision>.

#include <string>
#include <variant>

#include "flexarm/math/pose.h"

namespace flexarm::scene {

/// Shapes for displays and for contact. Cylinders are along z; the middle of each shape is at the origin.
struct BoxShape {
  Vector3 size = Vector3::Zero();  ///< [m]
};
struct CylinderShape {
  double radius = 0, length = 0;  ///< [m]
};
struct SphereShape {
  double radius = 0;  ///< [m]
};
struct MeshShape {
  std::string url;                  ///< package://PACKAGE/PATH or file://PATH
  Vector3 scale = Vector3::Ones();  ///< [m per unit of the file]
};
struct VisualDescription {
  Pose origin;  ///< in the link frame
  std::variant<BoxShape, CylinderShape, SphereShape, MeshShape> shape;
};

}  // namespace flexarm::scene
