#pragma once
/// Values of the scene's functions of time over a step.

#include <algorithm>
#include <cmath>
#include <vector>

#include "integrators/step_configuration.h"

namespace flexarm {

/// What a coordinate is commanded, NaN where nothing is, or else the scene's effort for it; cut at its limit.
inline double applied_effort(const Coordinate& coordinate, double commanded, double of_scene) {
  const double effort = std::isnan(commanded) ? of_scene : commanded, limit = coordinate.effort_limit;
  return limit > 0 ? std::clamp(effort, -limit, limit) : effort;
}

/// Loads and efforts follow histories, times a factor by which statics lets them grow.
struct StepHistories {
  explicit StepHistories(const Model& model) : at_point(model.histories.size()), at_beginning(model.histories.size()) {}

  void begin(const StepConfiguration& configuration) {
    const Scheme& scheme = configuration.scheme();
    const double time = configuration.state().time;
    double point = scheme.hht == HhtForm::Kinematics ? 1 + scheme.alpha : 1;
    if (scheme.is_incremental()) point = 0.5;
    for (std::size_t i = 0; i < at_point.size(); ++i) {
      const TimeFunction& history = configuration.model().histories[i];
      at_point[i] = history(scheme.is_static ? 0.0 : time + point * configuration.step());
      if (!scheme.is_incremental() && !scheme.is_static) at_beginning[i] = history(time);
    }
  }

  double effort(const Coordinate& coordinate, double commanded) const {
    return factor * applied_effort(coordinate, commanded, coordinate.effort < 0 ? 0.0 : at_point[coordinate.effort]);
  }

  std::vector<double> at_point;      ///< where in the step the scheme evaluates forces; at time 0 in statics
  std::vector<double> at_beginning;  ///< for the work of the Newmark family
  double factor = 1;
};

}  // namespace flexarm
