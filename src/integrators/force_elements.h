#pragma once
/// Force elements between points of links (springs, contacts), over a step or in an equilibrium.

#include <memory>
#include <vector>

#include "integrators/balance.h"
#include "integrators/far_elements.h"
#include "integrators/step_configuration.h"
#include "integrators/step_events.h"
#include "integrators/step_histories.h"

namespace flexarm {

/// Tells a model's tangent which nodes are coupled by force elements in small motions about a state.
void couple_force_elements(const Model& model, const State& state, TangentBackend& tangent);

/// The model's force elements as a part of the step.
class ForceElements {
 public:
  /// @throws ModelError if there are force elements and the scheme interpolates forces in time, or if the scheme does
  /// not suit one of them.
  ForceElements(const StepConfiguration& configuration, const StepHistories& histories);

  /// `tangent`: the backend that is used in this step.
  void begin(TangentBackend& tangent);
  void evaluate(Balance& balance);
  /// Whether a force element requires a shorter step, see ForceElement::needs_halves(). For a solved step.
  bool need_halves(double refinement);
  /// Notes when contacts begin and end in a solved step.
  void note_events(FirstEvent& first);
  /// Whether there may be a hit in the step begun last, see ForceElement::hits().
  bool may_hit() const { return may_hit_; }
  /// The first element whose forces were not finite at the last evaluation; -1: none.
  int not_finite() const { return not_finite_; }
  /// Adds the work of the elements at the last evaluation [J].
  void add_work(double& work) const { work += work_; }
  void accept(State& state) const;

 private:
  ForceStep step() const;
  ForceStep step_of(std::size_t k, ForceStep step);
  void find_functions();
  void evaluate(std::size_t k, const ForceStep& step, Balance& balance);

  const StepConfiguration& configuration_;
  const StepHistories& histories_;
  std::vector<FunctionStep> functions_;  // of all elements, one after the other
  FarElements far_;
  std::vector<std::vector<int>> nodes_;  // per element
  std::vector<char> acts_;               // per element: it acts on nodes, or has memory
  std::vector<int> memory_begins_;       // per element: index into memory_ and State::force_memory
  std::vector<int> function_begins_;     // per element: index into functions_
  std::vector<Vector6> velocities_;      // per node: {v, w} at the beginning of the step
  std::vector<double> residual_, tangent_, memory_;
  std::vector<std::unique_ptr<ForceWorkspace>> workspaces_;  // per element
  double work_ = 0;
  int not_finite_ = -1;
  bool may_hit_ = false;
  bool may_be_far_ = false;  // whether there is an element that can hit
};

}  // namespace flexarm
