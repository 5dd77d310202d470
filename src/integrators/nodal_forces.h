#pragma once
/// Weights, loads and externally applied wrenches at the nodes of a model over a step.

#include "elements/load.h"
#include "integrators/balance.h"
#include "integrators/step_histories.h"

namespace flexarm {

class NodalForces {
 public:
  NodalForces(const StepConfiguration& configuration, const StepHistories& histories);

  void evaluate(Balance& balance) const;
  /// Adds the work of loads over the step to `work` [J]. Weights are not included: they have a potential energy.
  void add_work(double& work) const;
  /// {force, moment about the node} of all loads and wrenches on the given links, which one node carries.
  Vector6 loads_on(const std::vector<bool>& links) const;

  // ---- the parts of evaluate()
  /// Calls visit(node, weight [N]) for all nodes with mass.
  template <class Visit>
  void for_each_weight(const Visit& visit) const {
    const Model& model = configuration_.model();
    for (const int node : heavy_nodes_)
      visit(node, Vector3(histories_.factor * model.inertias[node].total_mass * model.gravity));
  }
  /// Calls visit(node, LoadAction) for all loads and wrenches on nodes in the poses `end` at the end of the step.
  template <class Visit>
  void for_each_action(const std::vector<NodePose>& end, const Visit& visit) const {
    const LoadPoint point = load_point(configuration_.scheme());
    for_each_load([&](const NodalLoad& load, const StepForce& value) {
      visit(load.node, load_action(load, histories_.factor * value.acting, configuration_.begin()[load.node].rotation,
                                   end[load.node].rotation, point));
    });
  }

 private:
  /// Calls visit(load, StepForce of its history) for all loads and wrenches.
  template <class Visit>
  void for_each_load(const Visit& visit) const {
    for (const NodalLoad& load : configuration_.model().loads) visit(load, histories_.of_load(load.history));
    for (const NodalLoad& wrench : configuration_.state().wrenches) visit(wrench, StepForce{1.0, 1.0, 1.0});
  }
  void add_pull(const NodalLoad& load, Balance& balance) const;
  PullAction pull(const NodalLoad& load) const;

  const StepConfiguration& configuration_;
  const StepHistories& histories_;
  std::vector<int> heavy_nodes_;
};

}  // namespace flexarm
