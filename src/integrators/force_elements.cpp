#include "integrators/force_elements.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "flexarm/model/model_error.h"

namespace flexarm {

void couple_force_elements(const Model& model, const State& state, TangentBackend& tangent) {
  const std::vector<std::vector<int>> nodes = nodes_of(model.force_elements, state);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    tangent.couple(static_cast<int>(k), nodes[k].data(), static_cast<int>(nodes[k].size()));
}

ForceElements::ForceElements(const StepConfiguration& configuration, const StepHistories& histories)
    : configuration_(configuration),
      histories_(histories),
      far_(configuration.model().force_elements.size(), configuration.model().nodes.size()) {
  const ForceElementList& elements = configuration.model().force_elements;
  if (elements.empty()) return;
  const Scheme& scheme = configuration.scheme();
  const bool is_plain = scheme.is_static || (scheme.is_incremental() && !scheme.is_composition);
  for (const auto& element : elements)
    if ((!is_plain && !element->suits_all_schemes()) || (scheme.is_composition && !element->suits_backward_steps()))
      throw ModelError(
          fmt::format("<integrator>: scheme '{}' has no <{}>{}; take one of the energy-momentum family, such as em",
                      scheme.name, element->kind(), element->suits_all_schemes() ? " with friction or valves" : ""));
  if (scheme.hht != HhtForm::None)
    throw ModelError(fmt::format("schemes that interpolate forces in time (hht1, hht2, hht3) have no <{}>",
                                 elements.front()->kind()));
  int most = 0, memory = 0, functions = 0;
  std::size_t numbers = 0;
  for (const auto& element : elements) {
    memory_begins_.push_back(memory);
    function_begins_.push_back(functions);
    nodes_.emplace_back().reserve(element->most_nodes());
    const std::size_t size = 6 * element->most_nodes();
    most = std::max(most, static_cast<int>(size));
    const ForcePieces& pieces = element->pieces();
    numbers = std::max(numbers, pieces.pairs.empty() ? size * size : PieceTangent::size(pieces));
    memory += element->memory_size();
    functions += static_cast<int>(element->functions().size());
    may_be_far_ = may_be_far_ || element->hits();
    workspaces_.push_back(element->make_workspace());
  }
  residual_.resize(most);
  tangent_.resize(numbers);
  memory_.resize(memory);
  functions_.resize(functions);
  acts_.resize(elements.size());
  velocities_.resize(configuration.model().nodes.size());
}

/// Evaluates the elements' functions of time over the step.
void ForceElements::find_functions() {
  // As loads, they have their values at time 0 in statics.
  const bool is_static = configuration_.scheme().is_static;
  const double begin = is_static ? 0 : configuration_.state().time, end = is_static ? 0 : configuration_.end_time();
  FunctionStep* out = functions_.data();
  for (const auto& element : configuration_.model().force_elements)
    for (const int history : element->functions()) {
      const TimeFunction& function = configuration_.model().histories[history];
      *out++ = {function(begin), function(end), element->uses_means() ? function.mean(begin, end) : 0};
    }
}

void ForceElements::begin(TangentBackend& tangent) {
  if (nodes_.empty()) return;
  find_functions();
  const std::vector<NodeState>& states = configuration_.state().nodes;
  std::transform(states.begin(), states.end(), velocities_.begin(), spatial_velocity);
  const ForceElementList& elements = configuration_.model().force_elements;
  const ForceStart start{configuration_.begin(), velocities_, configuration_.step()};
  const ForceStep step = this->step();
  may_hit_ = false;
  if (may_be_far_) far_.begin(start);
  for (std::size_t k = 0; k < elements.size(); ++k) {
    nodes_[k].clear();
    acts_[k] = false;
    if (!far_.is_far(k)) {  // far elements have no memory
      std::fill_n(memory_.begin() + memory_begins_[k], elements[k]->memory_size(), 0.0);
      find_nodes(*elements[k], start, nodes_[k]);
      const double* memory = configuration_.state().force_memory.data() + memory_begins_[k];
      acts_[k] = !nodes_[k].empty() || elements[k]->remembers(memory);
      far_.set_room(k, acts_[k] ? ForceRoom{} : elements[k]->room(start));
      may_hit_ = may_hit_ || (start.duration != 0 && elements[k]->hits() && !nodes_[k].empty());
    }
    tangent.couple(static_cast<int>(k), nodes_[k].data(), static_cast<int>(nodes_[k].size()));
    if (acts_[k]) elements[k]->begin(step_of(k, step));
  }
}

/// The data of the step that are the same for all elements.
ForceStep ForceElements::step() const {
  const Scheme& scheme = configuration_.scheme();
  ForceStep step{configuration_.begin(), configuration_.end(), velocities_};
  step.duration = configuration_.step();
  step.at_end = !scheme.is_incremental();
  if (step.at_end) step.gamma = scheme.gamma;
  step.load_factor = histories_.factor;
  return step;
}

ForceStep ForceElements::step_of(std::size_t k, ForceStep step) {
  step.memory = configuration_.state().force_memory.data() + memory_begins_[k];
  step.new_memory = memory_.data() + memory_begins_[k];
  step.functions = functions_.data() + function_begins_[k];
  step.workspace = workspaces_[k].get();
  return step;
}

void ForceElements::evaluate(Balance& balance) {
  if (nodes_.empty()) return;
  const ForceStep step = this->step();
  work_ = 0;
  not_finite_ = -1;
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    if (acts_[k]) evaluate(k, step_of(k, step), balance);
}

void ForceElements::evaluate(std::size_t k, const ForceStep& step, Balance& balance) {
  const std::vector<int>& nodes = nodes_[k];
  const ForceElement& element = *configuration_.model().force_elements[k];
  const ForcePieces& pieces = element.pieces();
  const bool in_pieces = !pieces.pairs.empty();
  const Eigen::Index size = 6 * static_cast<Eigen::Index>(nodes.size()),
                     rows = balance.tangent && !in_pieces ? size : 0;
  ForceAction action{{residual_.data(), size},
                     {tangent_.data(), rows, rows},
                     balance.tangent && in_pieces ? PieceTangent::in(tangent_.data(), pieces) : PieceTangent()};
  element.evaluate(step, nodes.data(), action);
  if (not_finite_ < 0 && !std::isfinite(action.residual.sum() + action.dissipated)) not_finite_ = static_cast<int>(k);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    balance.residual.node(nodes[i]) += action.residual.segment<6>(6 * static_cast<Eigen::Index>(i));
  if (balance.tangent && in_pieces) balance.tangent->add_coupling(static_cast<int>(k), action.pieces);
  if (balance.tangent && !in_pieces) balance.tangent->add_coupling(static_cast<int>(k), action.tangent);
  balance.dissipated += action.dissipated;
  work_ += action.work;
}

bool ForceElements::need_halves(double refinement) {
  if (nodes_.empty()) return false;
  ForceStep step = this->step();
  step.refinement = refinement;
  if (may_be_far_) far_.end(step.begin, step.end);
  const ForceElementList& elements = configuration_.model().force_elements;
  for (std::size_t k = 0; k < elements.size(); ++k) {
    if (far_.stays_far(k)) continue;
    if (elements[k]->needs_halves(step_of(k, step), nodes_[k].data(), static_cast<int>(nodes_[k].size()))) return true;
  }
  return false;
}

// The rate at a touch is kept for the whole hit, so that touches are located as finely as jumps of forces. Where a
// contact ends, its force has a kink.
void ForceElements::note_events(FirstEvent& first) {
  if (!may_hit_) return;
  const ForceStep step = this->step();
  far_.end(step.begin, step.end);
  const ForceElementList& elements = configuration_.model().force_elements;
  const PenetrationTaker take = [&](double begin, double end, double begin_rate) {
    const double event = crossing(begin, end, 0, begin_rate * step.duration);
    end > 0 ? first.note_touch(event) : first.note_kink(event);
  };
  for (std::size_t k = 0; k < elements.size(); ++k)
    if (!far_.stays_far(k) && elements[k]->hits())
      elements[k]->put_penetrations(step_of(k, step), nodes_[k].data(), static_cast<int>(nodes_[k].size()), take);
}

void ForceElements::accept(State& state) const {
  const ForceElementList& elements = configuration_.model().force_elements;
  for (std::size_t k = 0; k < elements.size(); ++k)
    if (acts_[k])
      std::copy_n(memory_.begin() + memory_begins_[k], elements[k]->memory_size(),
                  state.force_memory.begin() + memory_begins_[k]);
}

}  // namespace flexarm
