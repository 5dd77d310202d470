#pragma once
/// Shapes of a link: URDF's <visual> and <collision>.

#include <array>
#include <optional>
#include <string>
#include <variant>

#include "flexarm/math/pose.h"

namespace flexarm::scene {

/// Shapes for display and contact. The origin is in the middle of each shape; the axis of a cylinder is z.
struct BoxShape {
  Vector3 size = Vector3::Zero();  ///< [m]
};
struct CylinderShape {
  double radius = 0, length = 0;  ///< [m]
  double inner_radius = 0;        ///< > 0: a tube, for contact only [m]
};
struct SphereShape {
  double radius = 0;  ///< [m]
};
struct MeshShape {
  std::string url;                  ///< package://PACKAGE/PATH or file://PATH
  Vector3 scale = Vector3::Ones();  ///< [m per unit of the file]
};
/// Red, green, blue and opacity, from 0 to 1.
using Color = std::array<double, 4>;
struct VisualDescription {
  Pose origin;  ///< in the link frame
  std::variant<BoxShape, CylinderShape, SphereShape, MeshShape> shape;
  std::optional<Color> color = {};  ///< of the <material>
};

/// Whether the shape is a point, which touches but is not shown.
inline bool is_point(const VisualDescription& visual) {
  const auto* sphere = std::get_if<SphereShape>(&visual.shape);
  return sphere && sphere->radius == 0;
}

}  // namespace flexarm::scene
