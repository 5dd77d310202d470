#pragma once
/// The two ends of a step: the configuration at its beginning, and the trial configuration at its end.

#include <vector>

#include "integrators/event_modes.h"
#include "integrators/free_nodes.h"
#include "integrators/step_events.h"
#include "integrators/step_motion.h"
#include "joints/joint_forces.h"
#include "joints/joint_map.h"
#include "joints/slide_map.h"
#include "model/degrees_of_freedom.h"
#include "schemes/scheme.h"
#include "solver/tangent_backend.h"

namespace flexarm {

/// The initial guess of a step's iteration.
enum class Guess {
  Extrapolated,  ///< from the last increments, see IncrementHistory; in the first step from the velocities
  Repeated,      ///< the last increments again
  Unchanged      ///< the configuration at the beginning
};

/// Poses of all nodes and all joint coordinates at both ends of a step, and quantities that follow from them alone.
/// Guesses and Newton updates move the trial end; slaves follow their joints.
class StepConfiguration {
 public:
  StepConfiguration(const Model& model, const Scheme& scheme, const DegreesOfFreedom& dof);
  StepConfiguration(const StepConfiguration&) = delete;  // the parts of the step refer to it

  /// Sets both ends to the configuration of `state`, which must outlive the step. `step` [s]; 0: statics.
  void begin(const State& state, double step);
  /// Moves the trial end by extrapolated increments of that order, see IncrementHistory.
  void extrapolate(const IncrementHistory& history, int order);
  /// Sets prescribed coordinates to their values at `time` [s], unless lead() has set others.
  void set_prescribed(double time);
  /// Leads prescribed coordinates in the next steps to these places, per coordinate; NaN: to that of the function.
  /// Null: all follow their functions again. `places` must outlive the steps.
  void lead(const std::vector<double>* places) { led_to_ = places; }
  const std::vector<double>* led_to() const { return led_to_; }
  /// Applies a Newton update, with one entry per unknown, to joint coordinates and to nodes that are not slaves.
  void update(const Eigen::VectorXd& increment);
  /// Sets mimic coordinates, slaves and increments. To be called after all other changes of the trial end.
  void set_slaves();
  /// Sets the trial end to the configuration of a state.
  void set_end(const State& state);
  /// Prescribes the branches of stops and friction. Null: they follow from the motion. `modes` must outlive the steps.
  void hold_modes(const EventModes* modes) { modes_ = modes; }
  const EventModes* held_modes() const { return modes_; }
  /// Writes the increments of the step into the history as its newest ones.
  void remember_increments(IncrementHistory& history) const;

  const Model& model() const { return model_; }
  const Scheme& scheme() const { return scheme_; }
  const DegreesOfFreedom& degrees_of_freedom() const { return dof_; }
  const State& state() const { return *state_; }  ///< at the beginning of the step
  double step() const { return step_; }           ///< [s]; 0: statics
  double end_time() const { return end_time_; }   ///< [s]
  const std::vector<NodePose>& begin() const { return begin_; }
  const std::vector<NodePose>& end() const { return end_; }
  const std::vector<Released>& released() const { return released_; }
  Released& released(int joint) { return released_[joint]; }
  /// Per node: tangent-scaled rotation increments over the step, that is, rotation vectors of the length 2
  /// tan(angle/2).
  const std::vector<Vector3>& increments() const { return increments_; }
  /// The largest tangent-scaled rotation increment, and its node.
  struct LargestIncrement {
    double size = 0;
    int node = 0;
  };
  LargestIncrement largest_increment() const;
  /// The first hinge coordinate that turns by more than half a turn. The rotations of its nodes are then ambiguous. -1
  /// if there is none.
  int aliased_coordinate() const;
  /// Angle by which a coordinate, other than components of rotation vectors, turns its joint [rad].
  double turn_of(const Coordinate& coordinate) const;
  StepMotion motion() const { return {*state_, begin_, end_, increments_, step_}; }
  /// Whether a slider has left its line, or passes more elements than allowed in a step.
  bool is_off_line() const { return off_line_joint_ >= 0; }
  int off_line_joint() const { return off_line_joint_; }  ///< the first such joint; -1: none
  /// Whether a prescribed motion is the cause, so that no shorter step can help.
  bool is_driven_off_line() const;
  /// How far a slider that may leave its line is beyond the end at most, relative to the length of the element there.
  double largest_way_beyond() const;
  /// Notes when sliders that may leave their lines reach the ends of these.
  void note_events(FirstEvent& first) const;

  /// Whether forces in the balance count as means over the step. In the Newmark family they are forces at the end of
  /// the step, and a mean needs those of the step before, too. In the first step, they count as means.
  bool forces_are_means() const { return scheme_.is_incremental() || state_->history.count == 0; }
  /// Factor of efforts in the rows of coordinates. It is not 1 in schemes that interpolate forces in time: there the
  /// balance holds between both ends of the step, and efforts are extrapolated to the end.
  double effort_weight() const { return effort_weight_; }

  // ---- joints over the step
  bool has_incremental_joints() const { return scheme_.is_incremental(); }
  /// Increments over the step: of all coordinates of a joint, and of one coordinate.
  ReleasedVector increment_of(int joint) const;
  double increment_of(const Coordinate& coordinate) const;
  /// Computes the maps of a joint, for the residual `g` on its slave.
  void joint_maps(int joint, const Vector6& g, FoldMaps& maps, bool with_tangent) const;
  void joint_maps(int joint, const Vector6& g, SlideMaps& maps, bool with_tangent) const;
  MimicMap mimic_map(int coordinate) const;
  /// The data of the step that passive efforts on a coordinate depend on.
  CoordinateStep coordinate_step(std::size_t coordinate, double increment) const;
  /// Rates of a joint's coordinates at the beginning. Valid after keep_begin_rates(), or find_begin_rates() in this
  /// step.
  const ReleasedVector& begin_rates(int joint) const { return begin_rates_[joint]; }
  void find_begin_rates();
  /// Rate of a coordinate at the end, by the scheme's rule from its increment. Requires begin_rates().
  double end_rate(const Coordinate& coordinate) const;
  /// From now on computes begin_rates() in every step. The Newmark family always does.
  void keep_begin_rates() { keeps_begin_rates_ = !scheme_.is_static; }

 private:
  void guess_from(const IncrementHistory& history, int order);
  void guess_from_velocities();
  SlideTravel slide_travel(int joint) const;
  double largest_overshoot(const JointMap& joint) const;
  bool is_on_line(const JointMap& joint, int j) const;

  const Model& model_;
  Scheme scheme_;
  const DegreesOfFreedom& dof_;
  FreeNodes free_nodes_;
  Eigen::VectorXd guess_;  // guessed increments, one entry per unknown
  const State* state_ = nullptr;
  double step_ = 0, end_time_ = 0, effort_weight_ = 1;
  std::vector<NodePose> begin_, end_;
  std::vector<Released> released_;
  std::vector<slide::Place> begin_places_, end_places_;  // per joint, valid for sliders; empty if there are none
  std::vector<Vector3> increments_;
  int off_line_joint_ = -1;
  bool keeps_begin_rates_ = false;
  const EventModes* modes_ = nullptr;
  const std::vector<double>* led_to_ = nullptr;
  std::vector<Vector6> begin_velocities_;  // per node, spatial
  std::vector<ReleasedVector> begin_rates_;
};

}  // namespace flexarm
