#pragma once
/// Does a configuration depend on how it was reached? (Muñoz 2004, table 5.3)

#include "bench/run.h"

namespace flexarm::bench {

/// How nodal rotations are updated from one iterate to the next (Muñoz 2004, tables 5.1 and 5.2).
enum class RotationUpdate { Additive, Spin };

/// How far the stiffness points of a three-node element lie apart when the same nodal rotations are reached in
/// different ways.
struct PathDifference {
  double rotation = 0;   ///< largest angle between them [rad]
  double curvature = 0;  ///< largest difference, relative to the largest curvature
};
struct PathDependence {
  PathDifference by_increments;  ///< one, two or eight increments of one iterate each
  PathDifference by_iterates;    ///< one increment of one or of four iterates
  PathDifference largest() const;
};

PathDependence path_dependence(Interpolation interpolation, RotationUpdate update);

/// Largest distance of the tip of a cantilever under a dead tip load in 3D in equilibrium, found in 1, 4 and 16 load
/// steps, relative to its length: the same of the whole program. With reason if there is a solution that is not found.
Measured<double> static_path_dependence(const Variant& variant);

}  // namespace flexarm::bench
