#include "integrators/bodies.h"

#include <algorithm>
#include <cassert>

#include "elements/nodal_inertia.h"

namespace flexarm {

Bodies::Bodies(const StepConfiguration& configuration)
    : configuration_(configuration),
      conserving_nodes_(configuration.model(), configuration.scheme()),
      keeps_momentum_rates_(configuration.scheme().hht != HhtForm::None),
      end_momentum_rates_(configuration.model().nodes.size(), Vector3::Zero()) {}

void Bodies::initialise(State& state) const {
  const Model& model = configuration_.model();
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    const NodeState& node = state.nodes[i];
    state.momentum_rates[model.mass_point_count + i] = momentum_rate(
        node_pose(node).rotation, model.inertias[i].rotary, {node.angular_velocity, node.angular_acceleration});
  }
}

void Bodies::evaluate(Balance& balance) {
  const Scheme& scheme = configuration_.scheme();
  if (scheme.stress == StressRule::Conjugate) {
    conserving_nodes_.add(configuration_.motion(), balance);
    return;
  }
  const Model& model = configuration_.model();
  const State& state = configuration_.state();
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const NodalInertia& inertia = model.inertias[i];
    if (inertia.empty()) continue;
    NodeStep step{configuration_.begin()[i],
                  configuration_.end()[i],
                  state.nodes[i],
                  configuration_.increments()[i],
                  configuration_.inverse_tangents()[i],
                  configuration_.step()};
    if (keeps_momentum_rates_) step.momentum_rate = state.momentum_rates[model.mass_point_count + i];
    const NodalAction action = nodal_inertia_action(inertia, scheme, step, balance.tangent != nullptr);
    const int node = static_cast<int>(i);
    balance.residual.node(node) += action.residual;
    end_momentum_rates_[i] = action.residual.tail<3>();
    if (!balance.tangent) continue;
    Eigen::Map<Matrix6> tangent(balance.tangent->diagonal_block(node));
    tangent.topLeftCorner<3, 3>().diagonal().array() += action.translational;
    tangent.bottomRightCorner<3, 3>() += action.rotational;
  }
}

void Bodies::accept(State& state) const {
  assert(state.nodes.size() == configuration_.begin().size());
  for (std::size_t i = 0; i < state.nodes.size(); ++i)
    state.nodes[i] = advanced(configuration_.scheme(), {configuration_.begin()[i], configuration_.end()[i],
                                                        state.nodes[i], configuration_.increments()[i],
                                                        configuration_.inverse_tangents()[i], configuration_.step()});
  if (keeps_momentum_rates_)
    std::copy(end_momentum_rates_.begin(), end_momentum_rates_.end(),
              state.momentum_rates.begin() + configuration_.model().mass_point_count);
}

}  // namespace flexarm
