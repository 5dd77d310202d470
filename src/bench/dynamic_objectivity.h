#pragma once
/// Measures whether the relative motion in a spinning beam depends on its spin.

#include "bench/run.h"

namespace flexarm::bench {

/// Changes relative to the largest values of the twist, and of the difference between the angular velocities at the
/// points (or nodes) that carry the rotary inertia.
struct SpinDependence {
  double twist = 0, angular_velocity = 0;
};

/// A free straight two-node beam that twists to and fro, 12 steps of 0.1 s: compares a beam that spins about its axis
/// at 5 rad/s with one that does not spin. In the exact motion, and with linear velocity updates, there is no
/// difference. (Muñoz 2004, sec. 6.2)
Measured<SpinDependence> spin_dependence(const Variant& variant);

}  // namespace flexarm::bench
