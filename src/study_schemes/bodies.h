#pragma once
/// Inertia of rigid bodies and lumped inertia of beams, at the nodes, over a step, one node at a time.

#include <vector>

#include "integrators/balance.h"
#include "study_schemes/integration_points.h"
#include "study_schemes/nodal_inertia.h"

namespace flexarm {

class Bodies {
 public:
  /// `points`: has the inverse tangents of the nodes' increments; must outlive this.
  Bodies(const StepConfiguration& configuration, const IntegrationPoints& points);

  /// Hilber-Hughes-Taylor family: writes the momentum rates of the nodes at the beginning into the state.
  void initialise(State& state) const;
  /// Calls visit(node, NodalAction) for all nodes at which beams' damping is lumped.
  template <class Visit>
  void for_each_damping(bool with_tangent, const Visit& visit) const {
    for (const int node : damped_nodes_)
      visit(node, nodal_damping_action(configuration_.model().inertias[node], configuration_.scheme(), step_of(node),
                                       with_tangent));
  }
  void add_inertia(Balance& balance);
  NodeState motion_at_end(int node) const { return advanced(configuration_.scheme(), step_of(node)); }
  /// Writes the nodes' motion at the end of the step.
  void accept(State& state) const;

 private:
  NodeStep step_of(int node) const;

  const StepConfiguration& configuration_;
  const IntegrationPoints& points_;
  std::vector<int> damped_nodes_;
  bool keeps_momentum_rates_;
  std::vector<Vector3> end_momentum_rates_;  // per node
};

}  // namespace flexarm
