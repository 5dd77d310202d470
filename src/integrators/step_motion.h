#pragma once
/// The motion of all nodes over a step.

#include <vector>

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

struct StepMotion {
  const State& state;  ///< at the beginning of the step
  const std::vector<NodePose>&begin, &end;
  const std::vector<Vector3>& increments;  ///< tangent-scaled rotations
  double step;                             ///< [s]
};

}  // namespace flexarm
