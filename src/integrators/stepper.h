#pragma once
/// Step control around Newton's method: halve on failure, recover after success.

#include <memory>

#include "flexarm/model/results.h"
#include "integrators/deadline.h"
#include "integrators/newton.h"
#include "integrators/step_follower.h"
#include "integrators/step_settings.h"
#include "integrators/step_system.h"

namespace flexarm {

class DissipativeSubstitute;

/// Advances states of one model with one scheme. Allocates nothing after the first step, but when a slider enters
/// another element and the model needs a matrix (see SparseTangent).
class Stepper {
 public:
  Stepper(const Model& model, const Scheme& scheme, const StepSettings& settings);
  ~Stepper();

  /// One step of settings.step, in sub-steps of step / 2^k where Newton or a hit on a stop needs them. On failure the
  /// state is that after the last good sub-step, or the step is done otherwise, see OnFailure.
  StepResult advance(State& state);
  /// The same as a part of something whose time runs already.
  StepResult advance(State& state, const Deadline& deadline);
  /// For a step that ended as Reason::EventWithin: time of the event from the beginning of the step [s].
  double event() const { return event_; }
  /// Adds to an initial state what the scheme keeps there; accelerations (Newmark family) come from a short
  /// momentum-conserving step. @returns what that step came to; where it has failed, accelerations are zero
  StepResult initialise(State& state);
  /// Sets the length of whole steps from now on [s]. Constants that the scheme took from the first length stay.
  void set_step(double step, const EventSearch& events = {});
  /// Of Newton's method, see StepSettings.
  void set_tolerance(double tolerance);
  /// The state was changed by somebody else: forget what was kept from the last step.
  void invalidate();

  const StepSettings& settings() const { return settings_; }
  /// Update norms of the last Newton solve, for tests of the rate of convergence.
  const std::vector<double>& update_norms() const { return newton_.update_norms(); }
  const DegreesOfFreedom& degrees_of_freedom() const { return system_.degrees_of_freedom(); }
  /// Tells the phases of all steps from now on; null: nobody.
  void observe(StepObserver* observer);
  /// Takes somebody along from now on; null: nobody.
  void accompany(StepFollower* follower) { follower_ = follower; }

 private:
  StepResult advance_by_scheme(State& state, const Deadline& deadline);
  /// What has come to nothing by now: where, and why.
  StepResult give_up(bool is_late, StepResult result);
  StepResult initialise_accelerations(State& state);
  /// A step of a composed scheme is several simple ones; on failure the state is untouched.
  bool sub_step(State& state, double step, StepResult& result);
  bool simple_step(State& state, double step, StepResult& result);
  /// Why a solution is not to be accepted. Notes the largest rotation, and when an event happens.
  StepResult::Reason flaw_of_solution(const State& state, double step, StepResult& result);
  /// Of a solution that would be good enough for a longer step control.
  StepResult::Reason flaw_by_events(const State& state, double step, const StepResult& result);
  void enter(StepPhase phase) {
    if (observer_) observer_->enter(phase);
  }

  const Model& model_;
  Scheme scheme_;
  StepSettings settings_;
  StepSystem system_;
  NewtonIteration newton_;
  std::unique_ptr<DissipativeSubstitute> substitute_;  // where it is allowed
  State before_;                                       // of a step that may have to be taken back
  double begin_ = 0, event_ = 0;                       // of the whole step; from there on [s]
  StepObserver* observer_ = nullptr;
  StepFollower* follower_ = nullptr;
};

}  // namespace flexarm
