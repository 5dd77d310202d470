#pragma once
/// What slows a mechanism down on its way to an equilibrium.

#include "integrators/balance.h"
#include "integrators/step_configuration.h"

namespace flexarm {

/// Springs without memory that draw every node back to where the step began: with them, equilibria are implicit Euler
/// steps of a motion through a fluid so thick that nothing has inertia. In statics alone.
class Drag {
 public:
  explicit Drag(const StepConfiguration& configuration) : configuration_(configuration) {}

  /// Against a displacement by the model's length scale, and a turn by one rad [J]; 0: there is none.
  double strength = 0;

  void evaluate(Balance& balance) const;
  /// The largest of all nodes' displacements, over the model's length scale, and turns over the step [rad]; half a turn
  /// is infinite.
  double largest_way() const;

 private:
  Vector3 displacement(std::size_t node) const;
  Vector3 turn(std::size_t node) const;

  const StepConfiguration& configuration_;
};

}  // namespace flexarm
