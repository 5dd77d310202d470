#pragma once
/// Weights, loads, dampers and externally applied wrenches at the nodes of a model over a step.

#include "elements/load.h"
#include "integrators/hht_interpolation.h"
#include "integrators/step_histories.h"

namespace flexarm {

class NodalForces {
 public:
  /// `interpolation`: null unless the scheme interpolates forces in time.
  NodalForces(const StepConfiguration& configuration, const StepHistories& histories, HhtInterpolation* interpolation);

  void evaluate(Balance& balance) const;
  /// Adds the work of loads over the step to `work` [J]. Weights are not included: they have a potential energy.
  void add_work(double& work) const;
  /// {force, moment about the node} of all loads and wrenches on the given links, which one node carries.
  Vector6 loads_on(const std::vector<bool>& links) const;

 private:
  /// Calls visit(load, StepForce of its history) for all loads and wrenches.
  template <class Visit>
  void for_each_load(const Visit& visit) const;
  void add_weight(int node, Balance& balance) const;
  void add_damping(int node, Balance& balance) const;
  void add_pull(const NodalLoad& load, Balance& balance) const;
  PullAction pull(const NodalLoad& load) const;
  void add(int node, const Vector6& force, Eigen::Matrix<double, 6, 3> rotational, bool of_configuration,
           bool with_tangent, Balance& balance) const;

  const StepConfiguration& configuration_;
  const StepHistories& histories_;
  HhtInterpolation* interpolation_;
  std::vector<int> heavy_nodes_, damped_nodes_;
};

}  // namespace flexarm
