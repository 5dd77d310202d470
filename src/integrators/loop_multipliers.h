#pragma once
/// The Lagrange multipliers of loop closures during a step, and their forces.

#include <vector>

#include "integrators/balance.h"
#include "integrators/step_configuration.h"

namespace flexarm {

class LoopMultipliers {
 public:
  explicit LoopMultipliers(const StepConfiguration& configuration);

  /// Sets all multipliers to zero.
  void begin();
  /// Sets the multipliers to those of the newest step of a history.
  void extrapolate(const IncrementHistory& history);
  void evaluate(Balance& balance) const;
  /// {force, moment} that the multipliers add to the residual of a closure's child.
  Vector6 on_child(int closure) const;
  /// Applies a Newton update with one entry per unknown.
  void update(const Eigen::VectorXd& increment);
  /// Writes the multipliers into the newest increments of a history, at their own equations.
  void remember(IncrementHistory& history) const;

  struct Opening {
    double size = 0;   ///< divided by the model's length scale, or in rad
    int closure = -1;  ///< the closure with this violation
  };
  /// Largest violation of constraints that the others of a loop imply. Not zero if the loop was singular at the start.
  Opening largest_opening() const;

  /// Weight of the end of the step in the directions along which multipliers act. Multipliers are constant over a step,
  /// and no scheme weights them.
  double end_weight() const;

 private:
  /// Calls visit(closure, index of the multiplier in it, equation) for all multipliers.
  template <class Visit>
  void for_each(const Visit& visit) const;

  const StepConfiguration& configuration_;
  std::vector<ReleasedVector> values_;  // per closure
};

}  // namespace flexarm
