#pragma once
/// Efforts of springs and dampers with play over a step. (docs/notes/drives.md)
///
/// Let x be the twist, y its part beyond the play, V = k y^2 / 2 the energy. Over a step of length h
///   effort = -(k (y_0 + y_1)/2 dy/dx + d dy/h),
/// where dy is the increment of y, and dy/dx the quotient of the increments. Its work is exactly the decrease of V
/// minus the energy that the damper dissipates. The effort always decreases with the twist at the end.

#include "joints/coordinate_step.h"
#include "model/actuator.h"

namespace flexarm {

/// Returns the effort on the twist. `twist`: its change over the step.
PassiveEffort elastic_effort(const Elasticity& elasticity, const CoordinateStep& twist);
/// The effort on a twist at an instant [N m or N], and the power that the damper dissipates [W].
struct ElasticInstant {
  double effort, dissipated;
};
/// Returns the effort at an instant. `rate`: of the twist [rad/s or m/s].
ElasticInstant elastic_instant(const Elasticity& elasticity, double twist, double rate);
/// Returns the elastic energy [J].
double elastic_energy(const Elasticity& elasticity, double twist);
/// Returns the damping coefficient at rest at this twist: minus the derivative of the effort with respect to the
/// twist's rate [N m s/rad or N s/m].
double elastic_damping(const Elasticity& elasticity, double twist);

}  // namespace flexarm
