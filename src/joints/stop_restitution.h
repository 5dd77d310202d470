#pragma once
/// Computes the damping of a stop for a given coefficient of restitution. (docs/notes/stops.md)

#include "math/pi.h"
#include "model/model.h"

namespace flexarm {

/// Phase angle by which a step of the scene's length advances the oscillator of stop and coordinate. With forces at the
/// end of steps, the damper reaches its full force over this angle.
constexpr double kRampAngle = kPi / 10;

/// Returns the damping ratios for a `restitution` from 0.05 to 1.
StopDamping damping_for(double restitution);

}  // namespace flexarm
