#include "study_schemes/bodies.h"

#include <algorithm>
#include <cassert>

namespace flexarm {

Bodies::Bodies(const StepConfiguration& configuration, const IntegrationPoints& points)
    : configuration_(configuration),
      points_(points),
      keeps_momentum_rates_(configuration.scheme().hht != HhtForm::None),
      end_momentum_rates_(configuration.model().nodes.size(), Vector3::Zero()) {
  const std::vector<NodalInertia>& inertias = configuration.model().inertias;
  for (std::size_t i = 0; i < inertias.size(); ++i)
    if (!inertias[i].rotary_damping.isZero(0)) damped_nodes_.push_back(static_cast<int>(i));
}

void Bodies::initialise(State& state) const {
  const Model& model = configuration_.model();
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    const NodeState& node = state.nodes[i];
    state.study.momentum_rates[model.mass_point_count + i] = momentum_rate(
        node_pose(node).rotation, model.inertias[i].rotary, node.angular_velocity, node.angular_acceleration);
  }
}

NodeStep Bodies::step_of(int node) const {
  NodeStep step{configuration_.begin()[node],      configuration_.end()[node],     configuration_.state().nodes[node],
                configuration_.increments()[node], points_.inverse_tangents[node], configuration_.step()};
  if (keeps_momentum_rates_)
    step.momentum_rate = configuration_.state().study.momentum_rates[configuration_.model().mass_point_count + node];
  return step;
}

void Bodies::add_inertia(Balance& balance) {
  const Model& model = configuration_.model();
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const NodalInertia& inertia = model.inertias[i];
    if (inertia.empty()) continue;
    const int node = static_cast<int>(i);
    const NodalAction action =
        nodal_inertia_action(inertia, configuration_.scheme(), step_of(node), balance.tangent != nullptr);
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
  for (std::size_t i = 0; i < state.nodes.size(); ++i) state.nodes[i] = motion_at_end(static_cast<int>(i));
  if (keeps_momentum_rates_)
    std::copy(end_momentum_rates_.begin(), end_momentum_rates_.end(),
              state.study.momentum_rates.begin() + configuration_.model().mass_point_count);
}

}  // namespace flexarm
