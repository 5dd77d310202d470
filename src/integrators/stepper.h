#pragma once
/// Step control around Newton's method: halves the step after a failure, and doubles it again after successes.

#include <functional>
#include <memory>

#include "flexarm/model/results.h"
#include "integrators/acceleration_finder.h"
#include "integrators/deadline.h"
#include "integrators/motion_kinks.h"
#include "integrators/newton.h"
#include "integrators/step_follower.h"
#include "integrators/step_settings.h"
#include "integrators/step_system.h"

namespace flexarm {

class DissipativeSubstitute;
class ExplicitStep;

/// Advances states of one model with one scheme. Allocates no memory after the first step, except when a slider enters
/// another element and the model needs a sparse matrix (see SparseTangent).
class Stepper {
 public:
  Stepper(const Model& model, const Scheme& scheme, const StepSettings& settings);
  ~Stepper();

  /// Does one step of settings.step, in sub-steps of step / 2^k if Newton's method or a hit on a stop needs them. After
  /// a failure the state is that after the last good sub-step, or another scheme has done the step, see OnFailure.
  StepResult advance(State& state);
  /// The same with a deadline that is already running.
  StepResult advance(State& state, const Deadline& deadline);
  /// The same, but the step ends early, soon after a slider has come to the end of a line that it may leave
  /// (JointMap::leaving), or if `is_end` is true after a sub-step; null: never. The caller then changes the model.
  /// Steps with a search for events do not end early.
  StepResult advance_until(State& state, const std::function<bool(const State&)>& is_end = nullptr);
  /// What is left of a step that has ended early [s]; 0: nothing.
  double rest() const { return rest_; }
  /// After a step with Reason::EventWithin: time of the event, counted from the beginning of the step [s].
  double event() const { return event_; }
  /// Adds the scheme's own data to an initial state. Accelerations (Newmark family) come from a short
  /// momentum-conserving step.
  /// @returns the result of that step; if it failed, accelerations are zero
  StepResult initialise(State& state);
  /// Sets the length of whole steps from now on [s]. Constants that the scheme took from the first length stay.
  void set_step(double step, const EventSearch& events = {});
  /// Sets the tolerance of Newton's method, see StepSettings.
  void set_tolerance(double tolerance);
  /// For Newmark's rule, before a step of this length [s]: makes accelerations anew after an event, at which forces may
  /// have jumped. Allocates memory when it is called for the first time. Returns whether the state has changed.
  /// (docs/schemes.md)
  bool begin_anew(State& state, double step);
  /// Discards data kept from the last step. To be called after the state was changed by something other than a step.
  void invalidate();

  const StepSettings& settings() const { return settings_; }
  /// Update norms of the last Newton solve, for tests of the convergence rate.
  const std::vector<double>& update_norms() const { return newton_.update_norms(); }
  const DegreesOfFreedom& degrees_of_freedom() const { return system_.degrees_of_freedom(); }
  /// Sets the observer of phases for all following steps; null: none.
  void observe(StepObserver* observer);
  /// Sets the follower for all following steps; null: none.
  void accompany(StepFollower* follower) { follower_ = follower; }

 private:
  /// Whether steps take accelerations over from the step before, as Newmark's rule does.
  bool keeps_accelerations() const;
  /// Calls begin_anew() if the next sub-step is much shorter than the last one, and events are located.
  void begin_anew_if_shorter(State& state, double step);
  StepResult advance_by_scheme(State& state, const Deadline& deadline);
  /// Does sub-steps of this time until it is over, one fails, or a slider leaves. Returns false after a failure.
  bool do_sub_steps(State& state, double duration, const Deadline& deadline, StepResult& result);
  /// Completes the result of a failed step with the place and the reason.
  StepResult give_up(bool is_late, StepResult result);
  /// Does one sub-step. A composed scheme does several simple steps. After a failure the state is unchanged.
  bool sub_step(State& state, double step, StepResult& result);
  bool simple_step(State& state, double step, StepResult& result);
  /// If rates of prescribed motions jump here, does the first, very short sub-steps (MotionKinks). Returns their length
  /// [s].
  double follow_kinks(State& state, StepResult& result);
  bool explicit_step(State& state, double step, StepResult& result);
  /// Returns the reason why a solution must not be accepted. Records the largest rotation and the time of an event.
  StepResult::Reason flaw_of_solution(const State& state, double step, StepResult& result);
  /// Returns the reason due to the search for events; called for solutions without any other flaw.
  StepResult::Reason flaw_by_events(const State& state, double step, const StepResult& result);
  void enter(StepPhase phase) {
    if (observer_) observer_->enter(phase);
  }

  const Model& model_;
  Scheme scheme_;
  StepSettings settings_;
  StepSystem system_;
  NewtonIteration newton_;
  MotionKinks kinks_;
  bool may_release_;                                   // whether there are sliders that may leave their lines
  std::unique_ptr<DissipativeSubstitute> substitute_;  // null unless OnFailure::Dissipate
  std::unique_ptr<ExplicitStep> explicit_;             // null unless the scheme is explicit
  std::unique_ptr<AccelerationFinder> accelerations_;  // null until begin_anew()
  State before_;                                       // state at the beginning of a composed step, to undo it
  double begin_ = 0, event_ = 0;                       // start of the whole step; time from there to the event [s]
  double rest_ = 0;                                    // what is left of a step that has ended early [s]
  bool ends_at_release_ = false;                       // during advance_until()
  const std::function<bool(const State&)>* is_end_ = nullptr;  // during advance_until()
  StepObserver* observer_ = nullptr;
  StepFollower* follower_ = nullptr;
};

}  // namespace flexarm
