#pragma once
/// Linearisation of a stiffness point in the additive weak form (beam.md 2.2).

#include "elements/beam_point.h"

namespace flexarm::additive {

/// In the coordinates (r', theta', theta).
using PointMatrix = Eigen::Matrix<double, 9, 9>;

/// d{n, T^T m, T'^T m - T^T (r' x n)}: the material part and the geometric part G (beam.md 2.2).
/// `n`, `m`: resultants in space; `theta`, `slope`: the interpolated total rotation vector and its derivative.
PointMatrix point_tangent(const PointKinematics& point, const Matrix6& stiffness, const Vector3& n, const Vector3& m,
                          const Vector3& theta, const Vector3& slope);

}  // namespace flexarm::additive
