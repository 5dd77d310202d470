#pragma once
/// The equations of one step, or of an equilibrium, as functions of the trial configuration at its end.
///
/// A step consists of parts. Each part owns its data and implements some of these functions:
///
///   begin()     starts a step from a state; the trial configuration is the one at the beginning
///   evaluate()  adds its contributions to the balance: the residual and, if required, the tangent
///   update()    is called when Newton's method has moved the unknowns
///   revise()    chooses the active sets of the equations again, such as the coordinates that stick
///   accept()    writes its result of the step into the new state
///
/// All parts refer to one StepConfiguration, which has both ends of the step. A new part needs its own files, a member
/// in the list below, and its calls in step.cpp. Parts do not know schemes by name, only the rules of a scheme's table
/// row. Equilibrium is one of these rules (`statics_of`).

#include <memory>

#include "integrators/actuators.h"
#include "integrators/drag.h"
#include "integrators/dry_friction_step.h"
#include "integrators/force_elements.h"
#include "integrators/joint_efforts.h"
#include "integrators/joint_fold.h"
#include "integrators/joint_reactions.h"
#include "integrators/loop_multipliers.h"
#include "integrators/nodal_forces.h"
#include "integrators/smooth_reversals.h"
#include "integrators/step_configuration.h"
#include "integrators/step_histories.h"
#include "integrators/step_space.h"
#include "integrators/stop_contacts.h"
#include "integrators/unknown_scales.h"

namespace flexarm {

/// Allocates no memory after construction, except in KLU when a slider enters another element of its line.
class StepSystem {
 public:
  /// The model must outlive the system.
  StepSystem(const Model& model, const Scheme& scheme, BackendChoice backend = BackendChoice::Fastest,
             Space space = Space::ThreeDimensional);

  /// Adds the scheme's own data to an initial state.
  void initialise(State& state);
  /// Starts a step of length `step` [s] from `state`, which must outlive the step. Sets prescribed coordinates to their
  /// values at the end.
  void begin(const State& state, double step, Guess guess);
  /// Starts the step that `other` has solved, from another state, which must outlive the step. The model of `other` is
  /// similar, its scheme the same. Uses the newest increments and multipliers of `guess`, and the active sets of
  /// `other`, see revise().
  void begin_beside(const StepSystem& other, const State& state, const IncrementHistory& guess);
  /// Prescribes the branches of stops and dry friction from the next step on. Null: each step finds them. `modes` must
  /// outlive the steps.
  void hold_modes(const EventModes* modes) { configuration_.hold_modes(modes); }
  /// See StepConfiguration::lead().
  void lead(const std::vector<double>* places) { configuration_.lead(places); }
  const DryFrictionStep& friction() const { return friction_; }
  /// Sets the history of `end` as if one step of that length had led there from `begin`. Keeps its newest multipliers.
  void remember_step(const State& begin, double step, State& end);
  /// Writes the increments of the step, and the multipliers, into the history as its newest entries.
  void remember_increments(IncrementHistory& history) const;
  /// Starts the search for an equilibrium from `state`. The scheme must be made by statics_of(). Gravity and loads are
  /// scaled by `load_factor`; functions of time and motions have their values at time 0. `drag`: see Drag::strength.
  void begin_equilibrium(const State& state, double load_factor, double drag = 0);

  /// See Actuators::hold_rotors().
  void hold_rotors() { actuators_.hold_rotors(); }

  /// Evaluates the residual, and the tangent if required, in the trial configuration. Returns false if a value is not
  /// finite, or if a slider is off its line.
  bool evaluate(bool with_tangent);
  /// Updates the strains that the geometric part of the next tangent uses. To be called after a solution with new
  /// factors and before its update. `fraction`: share of the solution that the update applies.
  void carry_strains(double fraction);
  /// Applies a Newton update, with one entry per unknown, to the trial configuration. Slaves follow their joints.
  void update(const Eigen::VectorXd& increment);
  /// Chooses the active sets of the equations again, such as the coordinates that stick. To be called after an
  /// evaluation at an updated configuration. Null: the equations are unchanged. Otherwise the change in words.
  const char* revise() { return friction_.revise() ? "friction sticks or slips" : nullptr; }
  /// Whether the tangent that was evaluated last belongs to the present active sets and dimension (plane or space).
  bool tangent_holds() const { return friction_.tangent_holds() && evaluated_ == &tangent(); }
  /// Writes the trial configuration as the new state; an equilibrium at rest. It must be evaluated after its last
  /// update.
  void accept(State& state);
  /// Discards data kept from the last step. To be called after the state was changed by something other than a step.
  void invalidate() { space_.invalidate(); }
  /// Makes strains independent of the path to a configuration.
  void forget_path(State& state) { space_.family_in_space().forget_path(state); }

  const DegreesOfFreedom& degrees_of_freedom() const { return dof_; }
  const StepConfiguration& configuration() const { return configuration_; }
  const UnknownScales& scales() const { return scales_; }
  const Drag& drag() const { return drag_; }
  const Actuators& actuators() const { return actuators_; }
  const Eigen::VectorXd& residual() const { return residual_; }
  TangentBackend& tangent() { return space_.tangent(); }
  const TangentBackend& tangent() const { return space_.tangent(); }
  /// See LoopMultipliers::largest_opening().
  LoopMultipliers::Opening largest_opening() const { return loops_.largest_opening(); }
  /// Whether the step is too long for a hit, see StopContacts and ForceElement::needs_halves().
  bool hits_too_fast(double refinement) {
    return contacts_.hits_too_fast(refinement) || force_elements_.need_halves(refinement);
  }
  /// Whether the step is too long for a reversal of smooth friction, see SmoothReversals; also of rotors and lossy
  /// gears.
  bool turn_too_fast(double refinement) {
    return reversals_.turn_too_fast(refinement) || actuators_.turn_too_fast(refinement);
  }
  /// Notes when forces jump in the step, which reduces the order of the scheme: friction stops a coordinate or changes
  /// its direction, a stop or a body is touched, a gear enters or leaves its play, a slider reaches the end of its
  /// line. Also notes when forces have kinks: a stop begins or ceases to push, a body is left, a motor reaches or
  /// leaves its limit.
  void note_events(FirstEvent& first);
  /// Whether forces have a kink at an unknown time within the step: a resting coordinate begins to slide.
  bool has_kink() const { return friction_.breaks_away(); }
  bool may_hit() { return contacts_.may_hit() || force_elements_.may_hit(); }
  /// Whether bodies touch each other, or may do so in the step begun last.
  bool touches() const { return force_elements_.may_hit(); }
  /// The force element whose forces were not finite at the last evaluation; -1: none.
  int not_finite_force() const { return force_elements_.not_finite(); }
  /// Internal minus external forces on all nodes in the configuration of `state`, before joints fold them. The scheme
  /// must be made by statics_of().
  std::vector<Vector6> nodal_forces(const State& state);

 private:
  void start(const State& state, double step);
  void move_ahead(const IncrementHistory& history, int order);
  void place_followers();
  const Scheme& scheme() const { return configuration_.scheme(); }
  SchemeFamily& family() { return space_.family(); }
  void add_forces(Balance& balance);
  void accept_rest(State& state);

  DegreesOfFreedom dof_;
  StepConfiguration configuration_;
  StepHistories histories_;
  StepPrestrains prestrains_;
  // ---- the parts
  StepSpace space_;
  NodalForces forces_;
  ForceElements force_elements_;
  Drag drag_;
  LoopMultipliers loops_;
  DryFrictionStep friction_;
  JointEfforts efforts_;
  Actuators actuators_;
  JointFold joints_;
  JointReactions reactions_;
  HeldEfforts held_efforts_;
  SmoothReversals reversals_;
  StopContacts contacts_;
  // ---- the balance to which they add
  ReducedResidual rows_, carried_rows_;
  const TangentBackend* evaluated_ = nullptr;  // where the tangent was evaluated last
  double dissipated_ = 0;                      // over the step [J]
  Eigen::VectorXd residual_;
  std::vector<double> nodal_update_;
  UnknownScales scales_;
};

}  // namespace flexarm
