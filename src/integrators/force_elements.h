#pragma once
/// What acts between points, over a step or in an equilibrium.

#include <vector>

#include "integrators/balance.h"
#include "integrators/step_configuration.h"

namespace flexarm {

/// Tells a tangent of a model which nodes its force elements couple at these poses.
void couple_force_elements(const Model& model, const std::vector<NodePose>& poses, TangentBackend& tangent);

/// The model's force elements as a part of the step.
class ForceElements {
 public:
  /// @throws ModelError where there are some and the scheme interpolates forces in time.
  explicit ForceElements(const StepConfiguration& configuration);

  /// `tangent`: of the step's space.
  void begin(TangentBackend& tangent);
  void evaluate(Balance& balance);
  /// Of the last evaluation.
  void add_work(double& work) const { work += work_; }
  void accept(State& state) const;

 private:
  const StepConfiguration& configuration_;
  std::vector<std::vector<int>> nodes_;  // per element
  std::vector<Vector6> velocities_;      // {v, w} at the beginning, where forces are those at the end
  std::vector<double> residual_, tangent_, memory_;
  double work_ = 0;
};

}  // namespace flexarm
