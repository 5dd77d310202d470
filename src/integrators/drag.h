#pragma once
/// Artificial resistance that slows a mechanism down on its way to an equilibrium.

#include "integrators/balance.h"
#include "integrators/step_configuration.h"

namespace flexarm {

/// Springs that pull every node back to its position and orientation at the beginning of the step. With them, a search
/// for an equilibrium becomes implicit Euler steps of a motion through a very viscous fluid, without inertia. Only for
/// statics.
class Drag {
 public:
  explicit Drag(const StepConfiguration& configuration) : configuration_(configuration) {}

  /// Stiffness [J], for displacements divided by the model's length scale and rotations in rad; 0: no drag.
  double strength = 0;

  void evaluate(Balance& balance) const;
  /// The largest motion of a node over the step: displacement divided by the model's length scale, or rotation in rad
  /// (infinite for half a turn, since rotations are tangent-scaled).
  double largest_way() const;

 private:
  Vector3 displacement(std::size_t node) const;
  Vector3 turn(std::size_t node) const;

  const StepConfiguration& configuration_;
};

}  // namespace flexarm
