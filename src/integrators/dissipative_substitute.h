#pragma once
/// Uses edmc2 for the steps that another scheme cannot do.

#include "integrators/stepper.h"

namespace flexarm {

/// Takes the place of a scheme of the energy-momentum family for a step; their states are the same but for the memory
/// that numerical dissipation has. The memory begins as it does at the start of a motion, and is forgotten after the
/// step. What it holds of energy then, which is of second order in the step, counts as dissipated, less what it held at
/// the beginning: the account of the scheme stays exact.
class DissipativeSubstitute {
 public:
  /// The model must outlive the substitute.
  DissipativeSubstitute(const Model& model, const Scheme& scheme, const StepSettings& settings);

  /// See Stepper.
  void set_step(double step) { stepper_.set_step(step); }
  void set_tolerance(double tolerance) { stepper_.set_tolerance(tolerance); }
  /// A step may come that fails: the state at its beginning.
  void keep(const State& state) { begin_ = state; }
  /// Does the step from the state that was kept, in what is left of its time. On failure `state` is left alone. The
  /// effort is added to `result`.
  bool advance(State& state, const Deadline& deadline, StepResult& result);

 private:
  const Model& model_;
  Scheme scheme_, dissipative_;
  Stepper stepper_;
  State begin_, trial_;
};

}  // namespace flexarm
