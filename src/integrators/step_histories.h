#pragma once
/// Evaluates the scene's functions of time over a step.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "integrators/step_configuration.h"

namespace flexarm {

/// The commanded effort of a coordinate or, if that is NaN, the scene's effort for it; cut at the effort limit.
inline double applied_effort(const Coordinate& coordinate, double commanded, double of_scene) {
  const double effort = std::isnan(commanded) ? of_scene : commanded, limit = coordinate.effort_limit;
  return limit > 0 ? std::clamp(effort, -limit, limit) : effort;
}

/// The value of a function of time in a step.
struct StepForce {
  /// The value that the balance uses. Conserving schemes: the mean over the step. Newmark family: values whose sum over
  /// all steps gives the exact impulse.
  double acting = 0;
  double mean = 0;    ///< over the step
  double at_end = 0;  ///< value at the end of the step; in conserving schemes the mean

  /// For forces at the ends of steps. `earlier`, `point`: the forces that the last step and this one have at their
  /// ends, whose mean with the weights 1 - `share` and `share` would stand for that over this step.
  static StepForce at_points(double mean, double earlier, double point, double share = 0.5) {
    return {point + (mean - ((1 - share) * earlier + share * point)), mean, point};
  }
};

/// All functions of time for loads, efforts and servos. A factor scales loads and efforts, so that they can grow in
/// statics. Steps use integrals of the functions (docs/theory/time_integration.md,
/// "Forces that change within a step").
class StepHistories {
 public:
  explicit StepHistories(const Model& model);

  void begin(const StepConfiguration& configuration);
  /// Value of a load's function; in statics at time 0.
  const StepForce& of_load(int history) const { return loads_[history]; }
  /// Value of a servo's set point or feedforward.
  const StepForce& of_servo(int history) const { return servos_[history]; }
  /// Effort of the scene or of a command on a coordinate, cut at its limit at each instant.
  StepForce effort(const Model& model, std::size_t coordinate, double commanded) const;

  double factor = 1;

 private:
  std::vector<StepForce> loads_, servos_;  // per history
  std::vector<StepForce> efforts_;         // per coordinate
  // Indices of functions that vary; moved_: coordinates whose effort varies.
  std::vector<int> load_histories_, servo_histories_, moved_;
};

}  // namespace flexarm
