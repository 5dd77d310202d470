#pragma once
/// The equations of one step, or of an equilibrium, as a function of the trial configuration at its end.
///
/// A step is made of parts. Each owns what it needs from evaluation to evaluation and speaks some of the same verbs:
///
///   begin()     a step starts from a state; the configuration stands at its beginning
///   evaluate()  adds to the balance: the residual and, where asked for, the tangent
///   update()    Newton's method has moved the unknowns
///   revise()    sets by which the equations are chosen are chosen anew
///   accept()    writes what the step has come to as the new state
///
/// and all refer to one StepConfiguration, both ends of the step. To add a part: its own files, a member in the list
/// below, and its verbs in step.cpp. Parts do not know schemes by name, only the rules of
/// a scheme's row; equilibrium is a rule as well (`statics_of`).

#include <memory>

#include "integrators/actuators.h"
#include "integrators/beam_family.h"
#include "integrators/bodies.h"
#include "integrators/drag.h"
#include "integrators/dry_friction_step.h"
#include "integrators/force_elements.h"
#include "integrators/joint_efforts.h"
#include "integrators/joint_fold.h"
#include "integrators/joint_reactions.h"
#include "integrators/loop_multipliers.h"
#include "integrators/nodal_forces.h"
#include "integrators/planar_step.h"
#include "integrators/smooth_reversals.h"
#include "integrators/step_configuration.h"
#include "integrators/step_histories.h"
#include "integrators/stop_contacts.h"
#include "integrators/unknown_scales.h"

namespace flexarm {

/// Whether steps of a mechanism that moves in a plane are taken there. What they come to is the same.
enum class Space { ThreeDimensional, PlaneWhereFound };

/// Nothing allocates after construction, but KLU when a slider enters another element of its line.
class StepSystem {
 public:
  /// The model must outlive the system.
  StepSystem(const Model& model, const Scheme& scheme, BackendChoice backend = BackendChoice::Fastest,
             Space space = Space::ThreeDimensional);

  /// Adds to an initial state what the scheme keeps there.
  void initialise(State& state);
  /// Starts a step of length `step` [s] from `state`, which must outlive it. Prescribed coordinates take their end
  /// values.
  void begin(const State& state, double step, Guess guess);
  /// Starts the step that `other`, of a like model and the same scheme, has solved, from another state, which must
  /// outlive it: by the newest increments and multipliers of `guess`, and with the same sets, see revise().
  void begin_beside(const StepSystem& other, const State& state, const IncrementHistory& guess);
  /// From the next step on branches of stops and of dry friction are those; null: as each step finds them. Else it must
  /// outlive the steps.
  void hold_modes(const EventModes* modes) { configuration_.hold_modes(modes); }
  const DryFrictionStep& friction() const { return friction_; }
  /// As if one step of that length had led from one state to another one, whose newest multipliers it keeps.
  void remember_step(const State& begin, double step, State& end);
  /// Writes the increments of the step, and the multipliers, as the newest of the history.
  void remember_increments(IncrementHistory& history) const;
  /// Starts the search for an equilibrium, of a scheme made by statics_of(), from `state`: gravity and loads scaled by
  /// `load_factor`, histories and motions at time 0. `drag`: see Drag::strength.
  void begin_equilibrium(const State& state, double load_factor, double drag = 0);

  /// See Actuators::hold_rotors().
  void hold_rotors() { actuators_.hold_rotors(); }

  /// Assembles residual (and tangent) of the trial configuration. False if something is not finite, or a slider is off
  /// its line.
  bool evaluate(bool with_tangent);
  /// Before the update that the factors of the tangent evaluated last have given, if another tangent will follow:
  /// what the geometric part of that one sees. `fraction` of the solution that will be taken.
  void carry_strains(double fraction);
  /// Applies a Newton update (one entry per unknown) on the group; slaves follow their joints.
  void update(const Eigen::VectorXd& increment);
  /// After an evaluation at an updated configuration: decides anew what belongs to the sets by which the equations are
  /// chosen, as the coordinates that stick. Null: the equations are as before; else what has changed, in words.
  const char* revise() { return friction_.revise() ? "friction sticks or slips" : nullptr; }
  /// False if the tangent evaluated last was of other sets, or other dimensions.
  bool tangent_holds() const { return friction_.tangent_holds() && has_planar_tangent_ == is_planar(); }
  /// Writes the trial configuration, evaluated last without an update since, as the new state; an equilibrium at rest.
  void accept(State& state);
  /// The state was changed by somebody else: quantities kept from the last step do not hold.
  void invalidate();
  /// Of strains that depend on the way to a configuration: see RotationReference.
  void forget_path(State& state) { beams_->forget_path(state); }
  /// Whether the step begun last is taken in a plane.
  bool is_planar() const { return planar_ && planar_->is_on; }

  const DegreesOfFreedom& degrees_of_freedom() const { return dof_; }
  const StepConfiguration& configuration() const { return configuration_; }
  const UnknownScales& scales() const { return scales_; }
  const Drag& drag() const { return drag_; }
  const Actuators& actuators() const { return actuators_; }
  const Eigen::VectorXd& residual() const { return residual_; }
  TangentBackend& tangent() { return is_planar() ? planar_->tangent : *tangent_; }
  const TangentBackend& tangent() const { return is_planar() ? planar_->tangent : *tangent_; }
  /// See LoopMultipliers.
  LoopMultipliers::Opening largest_opening() const { return loops_.largest_opening(); }
  /// See StopContacts and ForceElement::needs_halves().
  bool hits_too_fast(double refinement) {
    return contacts_.hits_too_fast(refinement) || force_elements_.need_halves(refinement);
  }
  /// See SmoothReversals; of joints, rotors and losses of gears.
  bool turn_too_fast(double refinement) {
    return reversals_.turn_too_fast(refinement) || actuators_.turn_too_fast(refinement);
  }
  /// Notes when forces jump in the step, with which the order of the scheme is lost: friction stops a coordinate or
  /// turns its direction, a stop is touched, a gear comes out of its play or into it, a slider comes to the end of its
  /// line. And when they have kinks: a stop pushes no more or begins to, a motor comes to its limit or leaves it.
  void note_events(FirstEvent& first);
  /// True where forces have a kink within the step of which no one knows when: friction lets a coordinate go.
  bool has_kink() const { return friction_.breaks_away(); }
  bool may_hit() { return contacts_.may_hit() || force_elements_.may_hit(); }
  /// True where bodies touch each other, or may do so in the step begun last.
  bool touches() const { return force_elements_.may_hit(); }
  /// Internal less external forces on all nodes in the configuration of `state`, before joints fold them; of a scheme
  /// made by statics_of().
  std::vector<Vector6> nodal_forces(const State& state);

 private:
  void start(const State& state, double step);
  void move_ahead(const IncrementHistory& history, int order);
  void place_followers();
  const Scheme& scheme() const { return configuration_.scheme(); }
  BeamFamily& beams() { return is_planar() ? planar_->beams : *beams_; }
  void add_forces(Balance& balance);
  void accept_rest(State& state);

  const Model& model_;
  DegreesOfFreedom dof_;
  StepConfiguration configuration_;
  StepHistories histories_;
  StepPrestrains prestrains_;
  // ---- the parts
  std::unique_ptr<BeamFamily> beams_;
  std::unique_ptr<HhtInterpolation> interpolation_;  // null unless forces are interpolated in time
  NodalForces forces_;
  ForceElements force_elements_;
  Bodies bodies_;
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
  // ---- the balance of what they add
  ReducedResidual rows_, carried_rows_;
  std::unique_ptr<TangentBackend> tangent_;
  std::unique_ptr<PlanarStep> planar_;  // null unless there is a plane
  bool has_planar_tangent_ = false;
  double dissipated_ = 0;  // over the step [J]
  Eigen::VectorXd residual_;
  std::vector<double> nodal_update_;
  UnknownScales scales_;
};

}  // namespace flexarm
