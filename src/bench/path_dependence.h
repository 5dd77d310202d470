#pragma once
/// Measures whether a configuration depends on the path to it (Muñoz 2004, table 5.3).

#include "bench/run.h"

namespace flexarm::bench {

/// How nodal rotations are updated from one iterate to the next (Muñoz 2004, tables 5.1 and 5.2).
enum class RotationUpdate { Additive, Spin };

/// Difference between the stiffness points of a three-node element when the same nodal rotations are reached on
/// different paths.
struct PathDifference {
  double rotation = 0;   ///< largest angle between rotations [rad]
  double curvature = 0;  ///< largest difference, relative to the largest curvature
};
struct PathDependence {
  PathDifference by_increments;  ///< one, two or eight increments with one iterate each
  PathDifference by_iterates;    ///< one increment with one or with four iterates
  PathDifference largest() const;
};

PathDependence path_dependence(Interpolation interpolation, RotationUpdate update);

/// The same for the whole program: the static equilibrium of a cantilever under a dead tip load in 3D, with 1, 4 and 16
/// load steps. The result is the largest distance between positions of the tip, relative to the length, or a failure if
/// an existing solution is not found.
Measured<double> static_path_dependence(const Variant& variant);

}  // namespace flexarm::bench
