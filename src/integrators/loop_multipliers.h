#pragma once
/// Loops that multipliers close: their forces, and the multipliers during a step.

#include <vector>

#include "integrators/balance.h"
#include "integrators/step_configuration.h"

namespace flexarm {

class LoopMultipliers {
 public:
  explicit LoopMultipliers(const StepConfiguration& configuration);

  /// No forces.
  void begin();
  /// Those of the newest step of a history.
  void extrapolate(const IncrementHistory& history);
  void evaluate(Balance& balance) const;
  /// What they add to the residual of a closure's child.
  Vector6 on_child(int closure) const;
  /// A Newton update, one entry per unknown.
  void update(const Eigen::VectorXd& increment);
  /// The history keeps the multipliers in the place of increments of their own.
  void remember(IncrementHistory& history) const;

  struct Opening {
    double size = 0;   ///< over the model's length scale, or in rad
    int closure = -1;  ///< where
  };
  /// Largest violation of what the closures of loops imply: not zero where a loop was singular at the start.
  Opening largest_opening() const;

  /// Share of the end of the step in the vectors along which multipliers act. Multipliers are forces of the whole step:
  /// no scheme weights them.
  double end_weight() const;

 private:
  ClosurePoses poses(const LoopClosure& closure, const std::vector<NodePose>& nodes) const;
  /// visit(closure, multiplier of it, its equation)
  template <class Visit>
  void for_each(const Visit& visit) const;

  const StepConfiguration& configuration_;
  std::vector<ReleasedVector> values_;  // per closure
};

}  // namespace flexarm
