#pragma once
/// Springs between points of two links.

namespace flexarm {

/// Along the line between two points, with a damper beside it.
struct PointSpring {
  int closure = -1;        ///< index into Model::closures: which points; it has no constraints
  double stiffness = 0;    ///< [N/m]
  double rest_length = 0;  ///< [m]
  double damping = 0;      ///< [N s/m]
};

}  // namespace flexarm
