#pragma once
/// Springs between points over a step.

#include "elements/spring_action.h"
#include "integrators/step_configuration.h"
#include "solver/reduced_residual.h"

namespace flexarm {

class PointSprings {
 public:
  /// @throws ModelError where there are springs and the scheme interpolates forces in time.
  explicit PointSprings(const StepConfiguration& configuration);

  void evaluate(Balance& balance) const;

 private:
  ClosurePoses poses(const LoopClosure& ends, const std::vector<NodePose>& nodes) const;
  CoordinateStep change(const LoopClosure& ends, const ClosurePoses& begin, const ClosurePoses& end) const;

  const StepConfiguration& configuration_;
};

}  // namespace flexarm
