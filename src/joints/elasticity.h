#pragma once
/// Springs with play over a step. (docs/notes/drives.md)
///
/// Of the twist x an elastic element feels y, what is beyond the play: V = k y^2 / 2. Over a step
///   effort = -(k (y_0 + y_1)/2 dy/dx + d dy/h),
/// where dy/dx is the quotient of the increments: its work is exactly what leaves V, less what the damper takes. It
/// falls with the twist at the end, whatever else happens.

#include "joints/coordinate_step.h"
#include "model/actuator.h"

namespace flexarm {

/// On the twist.
PassiveEffort elastic_effort(const Elasticity& elasticity, const CoordinateStep& twist);
/// [J]
double elastic_energy(const Elasticity& elasticity, double twist);
/// Slope of the effort against the twist's rate, at rest [N m s/rad or N s/m].
double elastic_damping(const Elasticity& elasticity, double twist);

}  // namespace flexarm
