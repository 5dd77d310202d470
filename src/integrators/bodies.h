#pragma once
/// Inertia of rigid bodies and lumped inertia of beams, at the nodes, over a step.

#include <vector>

#include "integrators/balance.h"
#include "integrators/conserving_nodes.h"
#include "integrators/step_configuration.h"

namespace flexarm {

class Bodies {
 public:
  explicit Bodies(const StepConfiguration& configuration);

  /// Hilber-Hughes-Taylor family: writes the momentum rates of the nodes at the beginning into the state.
  void initialise(State& state) const;
  void evaluate(Balance& balance);
  /// Writes the nodes' motion at the end of the step.
  void accept(State& state) const;

 private:
  const StepConfiguration& configuration_;
  ConservingNodes conserving_nodes_;  // empty for schemes of other families
  bool keeps_momentum_rates_;
  std::vector<Vector3> end_momentum_rates_;  // per node
};

}  // namespace flexarm
