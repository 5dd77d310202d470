#pragma once
/// Does the relative motion of a spinning beam depend on how fast it spins?

#include "bench/run.h"

namespace flexarm::bench {

/// Changes relative to the largest values of the twist, and of the difference of the angular velocities at the points
/// (or nodes) that carry the rotary inertia.
struct SpinDependence {
  double twist = 0, angular_velocity = 0;
};

/// A free straight two-node beam that twists to and fro while it spins about its axis, 12 steps of 0.1 s: at 5 rad/s
/// against at rest. The exact motion, and one with linear velocity updates, does not know the difference.
/// (Muñoz 2004, sec. 6.2)
Measured<SpinDependence> spin_dependence(const Variant& variant);

}  // namespace flexarm::bench
