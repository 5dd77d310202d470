#pragma once
/// The damping with which a stop returns a given part of the speed of a hit. (docs/notes/stops.md)

#include "math/pi.h"
#include "model/model.h"

namespace flexarm {

/// Angle of the stop's oscillator in a step of the scene: while it turns through this, a damper of forces at the ends
/// of steps takes hold.
constexpr double kRampAngle = kPi / 10;

/// `restitution` from 0.05 to 1.
StopDamping damping_for(double restitution);

}  // namespace flexarm
