#pragma once
/// Repeats failed steps of another scheme with the dissipative scheme edmc2.

#include "integrators/stepper.h"

namespace flexarm {

/// Replaces a scheme of the energy-momentum family for one step. The states of the two schemes differ only in the
/// memory of numerical dissipation. This memory is initialised as at the start of a motion, and dropped after the step.
/// Its energy is of second order in the step. The change of this energy over the step counts as dissipated, so that the
/// energy balance of the replaced scheme stays exact.
class DissipativeSubstitute {
 public:
  /// The model must outlive the substitute.
  DissipativeSubstitute(const Model& model, const Scheme& scheme, const StepSettings& settings);

  /// See Stepper.
  void set_step(double step) { stepper_.set_step(step); }
  void set_tolerance(double tolerance) { stepper_.set_tolerance(tolerance); }
  /// Stores the state at the beginning of a step that may fail.
  void keep(const State& state) { begin_ = state; }
  /// Does the step from the stored state within the remaining time. Leaves `state` unchanged if that fails. Adds
  /// iterations and halvings to `result`.
  bool advance(State& state, const Deadline& deadline, StepResult& result);

 private:
  const Model& model_;
  Scheme scheme_, dissipative_;
  Stepper stepper_;
  State begin_, trial_;
};

}  // namespace flexarm
