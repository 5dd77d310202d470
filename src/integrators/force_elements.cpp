#include "integrators/force_elements.h"

#include <algorithm>

#include <fmt/format.h>

#include "flexarm/model/model_error.h"

namespace flexarm {

void couple_force_elements(const Model& model, const std::vector<NodePose>& poses, TangentBackend& tangent) {
  std::vector<int> nodes;
  for (std::size_t k = 0; k < model.force_elements.size(); ++k) {
    find_nodes(*model.force_elements[k], poses, nodes);
    tangent.couple(static_cast<int>(k), nodes.data(), static_cast<int>(nodes.size()));
  }
}

ForceElements::ForceElements(const StepConfiguration& configuration) : configuration_(configuration) {
  const ForceElementList& elements = configuration.model().force_elements;
  if (elements.empty()) return;
  if (configuration.scheme().hht != HhtForm::None)
    throw ModelError(
        fmt::format("schemes that interpolate forces in time (hht1, hht2, hht3) have no <{}> between points",
                    elements.front()->kind()));
  int most = 0, memory = 0;
  for (const auto& element : elements) {
    nodes_.emplace_back().reserve(element->most_nodes());
    most = std::max(most, 6 * element->most_nodes());
    memory += element->memory_size();
  }
  residual_.resize(most);
  tangent_.resize(static_cast<std::size_t>(most) * most);
  memory_.resize(memory);
  velocities_.resize(configuration.model().nodes.size());
}

void ForceElements::begin(TangentBackend& tangent) {
  if (nodes_.empty()) return;
  const ForceElementList& elements = configuration_.model().force_elements;
  for (std::size_t k = 0; k < elements.size(); ++k) {
    find_nodes(*elements[k], configuration_.begin(), nodes_[k]);
    tangent.couple(static_cast<int>(k), nodes_[k].data(), static_cast<int>(nodes_[k].size()));
  }
  if (configuration_.scheme().is_incremental()) return;
  const std::vector<NodeState>& states = configuration_.state().nodes;
  std::transform(states.begin(), states.end(), velocities_.begin(), spatial_velocity);
}

void ForceElements::evaluate(Balance& balance) {
  if (nodes_.empty()) return;
  const Scheme& scheme = configuration_.scheme();
  ForceStep step{configuration_.begin(), configuration_.end(), velocities_};
  step.duration = configuration_.step();
  step.at_end = !scheme.is_incremental();
  if (step.at_end) step.gamma = scheme.gamma;
  step.memory = configuration_.state().force_memory.data();
  step.new_memory = memory_.data();
  work_ = 0;
  const ForceElementList& elements = configuration_.model().force_elements;
  for (std::size_t k = 0; k < elements.size(); ++k) {
    const std::vector<int>& nodes = nodes_[k];
    const Eigen::Index size = 6 * static_cast<Eigen::Index>(nodes.size()), rows = balance.tangent ? size : 0;
    ForceAction action{{residual_.data(), size}, {tangent_.data(), rows, rows}};
    elements[k]->evaluate(step, nodes.data(), action);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      balance.residual.node(nodes[i]) += action.residual.segment<6>(6 * static_cast<Eigen::Index>(i));
    if (balance.tangent) balance.tangent->add_coupling(static_cast<int>(k), action.tangent);
    balance.dissipated += action.dissipated;
    work_ += action.work;
    step.memory += elements[k]->memory_size();
    step.new_memory += elements[k]->memory_size();
  }
}

void ForceElements::accept(State& state) const {
  std::copy(memory_.begin(), memory_.end(), state.force_memory.begin());
}

}  // namespace flexarm
