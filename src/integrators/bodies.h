#pragma once
/// Inertia of rigid bodies, and inertia of beams that is lumped at nodes, over a step.

#include <vector>

#include "integrators/balance.h"
#include "integrators/conserving_nodes.h"
#include "integrators/step_configuration.h"

namespace flexarm {

class Bodies {
 public:
  explicit Bodies(const StepConfiguration& configuration);

  /// Writes the nodes' momentum rates of the configuration at the beginning; Hilber-Hughes-Taylor family.
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
