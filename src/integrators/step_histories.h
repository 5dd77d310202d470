#pragma once
/// The scene's functions of time over a step.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "integrators/step_configuration.h"

namespace flexarm {

/// What a coordinate is commanded, NaN where nothing is, or else the scene's effort for it; cut at its limit.
inline double applied_effort(const Coordinate& coordinate, double commanded, double of_scene) {
  const double effort = std::isnan(commanded) ? of_scene : commanded, limit = coordinate.effort_limit;
  return limit > 0 ? std::clamp(effort, -limit, limit) : effort;
}

/// A function of time in a step.
struct StepForce {
  double acting = 0;  ///< in the balance: its mean, or in the Newmark family what makes the impulses of all steps exact
  double mean = 0;    ///< over the step
  double at_end = 0;  ///< value at the end; where forces are means the mean again
};

/// Loads and efforts follow histories, times a factor by which statics lets them grow; they enter a step by their
/// integrals (theory.md, "Forces that change within a step").
class StepHistories {
 public:
  explicit StepHistories(const Model& model);

  void begin(const StepConfiguration& configuration);
  /// Of loads; in statics at time 0.
  const StepForce& of_load(int history) const { return loads_[history]; }
  /// Of what controllers take.
  const StepForce& of_servo(int history) const { return servos_[history]; }
  /// Of a coordinate's effort, cut at its limit at each instant.
  StepForce effort(const Model& model, std::size_t coordinate, double commanded) const;

  double factor = 1;

 private:
  std::vector<StepForce> loads_, servos_;                      // per history
  std::vector<StepForce> efforts_;                             // per coordinate
  std::vector<int> load_histories_, servo_histories_, moved_;  // no constants; moved_: coordinates
};

}  // namespace flexarm
