#pragma once
/// Inertia of rigid bodies for {displacement, spin} in world axes (internal to building/).

#include "math/so3.h"
#include "model/model.h"

namespace flexarm {

/// Inertia about a node.
using SpatialInertia = Matrix6;

inline SpatialInertia own_inertia(const NodalInertia& inertia, const Matrix3& rotation) {
  SpatialInertia out = SpatialInertia::Zero();
  out.topLeftCorner<3, 3>().diagonal().setConstant(inertia.total_mass);
  out.bottomRightCorner<3, 3>() = rotation * (inertia.rotary + inertia.beam_rotary) * rotation.transpose();
  return out;
}

/// The inertia about another point. `way`: from that point to the present one.
inline SpatialInertia moved(const SpatialInertia& inertia, const Vector3& way) {
  Matrix6 columns = Matrix6::Identity();
  columns.topRightCorner<3, 3>() = -so3::hat(way);
  return columns.transpose() * inertia * columns;
}

}  // namespace flexarm
