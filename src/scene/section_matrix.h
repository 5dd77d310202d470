#pragma once
/// What stiffness and inertia matrices of a section must be.

#include "flexarm/math/pose.h"

namespace flexarm::scene {

/// Relative to the diagonal, since translations and rotations have different units.
bool is_symmetric(const Matrix6& matrix);

bool is_positive_definite(const Matrix6& matrix);

/// [[m 1, -m d^], [m d^, J]] with m > 0 and J - m d^T d^ (about the centre of mass) positive semidefinite.
bool is_inertia(const Matrix6& matrix);

}  // namespace flexarm::scene
