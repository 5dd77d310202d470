#pragma once
/// Inertia and damping lumped at the nodes of a model over a step of the energy-momentum family, in packs of nodes.

#include <array>
#include <vector>

#include "elements/conserving_node.h"
#include "integrators/balance.h"
#include "integrators/step_configuration.h"

namespace flexarm {

class ConservingNodes {
 public:
  /// All rules of the energy-momentum family rotate bodies by tangent-scaled increments.
  ConservingNodes(const Model& model, const TimeRule& rule);

  /// Adds the rates of momentum, and the damping, to the balance.
  void add(const StepMotion& step, Balance& balance) const;

 private:
  /// Nodes side by side in the lanes of a pack. If nodes do not fill the last pack, copies of the last one do.
  struct NodePack {
    int lanes = 0;  // in use
    std::array<int, Pack::kLanes> nodes;
    LumpedInertia<Pack> inertia;
    bool is_damped = false;
    Matrix3T<Pack> damping;  // see NodeDamping
  };

  double velocity_factor_;
  std::vector<NodePack> packs_;
};

/// A node's motion at the end of a step of a conserving scheme.
NodeState motion_at_end(const StepConfiguration& configuration, int node);
/// Writes the motion of all nodes at the end of such a step into the state.
void advance_nodes(const StepConfiguration& configuration, State& state);

}  // namespace flexarm
