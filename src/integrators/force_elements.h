#pragma once
/// Elements that act between points, over a step or in an equilibrium.

#include <vector>

#include "integrators/balance.h"
#include "integrators/far_elements.h"
#include "integrators/step_configuration.h"

namespace flexarm {

/// Tells a tangent of a model which nodes its force elements couple in small motions about a state.
void couple_force_elements(const Model& model, const State& state, TangentBackend& tangent);

/// The model's force elements as a part of the step.
class ForceElements {
 public:
  /// @throws ModelError where there are some and the scheme interpolates forces in time.
  explicit ForceElements(const StepConfiguration& configuration);

  /// `tangent`: of the step's space.
  void begin(TangentBackend& tangent);
  void evaluate(Balance& balance);
  /// See ForceElement::needs_halves(), of the step as it is solved.
  bool need_halves(double refinement);
  /// Something may be hit in the step begun last, see ForceElement::hits().
  bool may_hit() const { return may_hit_; }
  /// Of the last evaluation.
  void add_work(double& work) const { work += work_; }
  void accept(State& state) const;

 private:
  ForceStep step();
  void evaluate(std::size_t k, const ForceStep& step, Balance& balance);

  const StepConfiguration& configuration_;
  FarElements far_;
  std::vector<std::vector<int>> nodes_;  // per element
  std::vector<char> acts_;               // per element: on nodes, or it remembers something
  std::vector<int> memory_begins_;       // per element, in memory_ and State::force_memory
  std::vector<Vector6> velocities_;      // per node {v, w} at the beginning
  std::vector<double> residual_, tangent_, memory_;
  double work_ = 0;
  bool may_hit_ = false;
  bool may_be_far_ = false;  // some element is one that touches
};

}  // namespace flexarm
