#pragma once
/// Newmark's time integration rule.

#include <cassert>

#include "flexarm/math/pose.h"

namespace flexarm {

/// Newmark's rule over a step h (Muñoz 2004, eq. 4.1-4.4):
///   a_1 = (Delta x - h v_0 - (1/2 - beta) h^2 a_0) / (beta h^2),   v_1 = v_0 + h ((1 - gamma) a_0 + gamma a_1),
/// for translations and, with Delta x the material rotation increment, for rotations.
struct NewmarkRule {
  double beta = 0.25, gamma = 0.5, step = 0;
  double alpha = 0;  ///< strains are taken at t_{n+1+alpha} (HHT3)

  Vector3 acceleration(const Vector3& increment, const Vector3& velocity, const Vector3& acceleration) const {
    assert(beta != 0 && step != 0);
    return (increment - step * velocity - (0.5 - beta) * step * step * acceleration) / (beta * step * step);
  }
  Vector3 velocity(const Vector3& velocity, const Vector3& acceleration, const Vector3& new_acceleration) const {
    return velocity + step * ((1 - gamma) * acceleration + gamma * new_acceleration);
  }
  double acceleration_slope() const { return 1 / (beta * step * step); }
  double velocity_slope() const { return gamma / (beta * step); }
};

}  // namespace flexarm
