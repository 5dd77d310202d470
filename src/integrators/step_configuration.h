#pragma once
/// Both ends of a step: the configuration at its beginning, and the trial one at its end.

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

/// How the iteration of a step starts.
enum class Guess {
  Extrapolated,  ///< from the last increments, see IncrementHistory; continuing the velocities in the first step
  Repeated,      ///< the last increments again
  Unchanged      ///< the configuration at the beginning
};

/// Poses of all nodes and released coordinates at both ends of a step, and what follows from them alone. The trial end
/// is moved by guesses and by Newton's updates of the group's unknowns; slaves follow their joints.
class StepConfiguration {
 public:
  StepConfiguration(const Model& model, const Scheme& scheme, const DegreesOfFreedom& dof);
  StepConfiguration(const StepConfiguration&) = delete;  // parts of the step refer to it

  /// Both ends are the configuration of `state`, which must outlive the step. `step` [s]; 0: statics.
  void begin(const State& state, double step);
  /// Moves the trial end by the extrapolation of that order of a history, see IncrementHistory.
  void extrapolate(const IncrementHistory& history, int order);
  /// Prescribed coordinates take their values at `time` [s].
  void set_prescribed(double time);
  /// A Newton update, one entry per unknown: released coordinates and nodes that are no slaves.
  void update(const Eigen::VectorXd& increment);
  /// To be called when all else stands: following coordinates, slaves, increments.
  void set_slaves();
  /// inverse_tangents of all nodes.
  void set_inverse_tangents();
  /// The trial end becomes the configuration of a state.
  void set_end(const State& state);
  /// Null: stops hold as their penetration says. Else it must outlive the steps.
  void hold_modes(const EventModes* modes) { modes_ = modes; }
  const EventModes* held_modes() const { return modes_; }
  /// Writes the increments of the step as the newest of the history.
  void remember_increments(IncrementHistory& history) const;

  const Model& model() const { return model_; }
  const Scheme& scheme() const { return scheme_; }
  const DegreesOfFreedom& degrees_of_freedom() const { return dof_; }
  const State& state() const { return *state_; }  ///< at the beginning
  double step() const { return step_; }           ///< [s]; 0: statics
  const std::vector<NodePose>& begin() const { return begin_; }
  const std::vector<NodePose>& end() const { return end_; }
  const std::vector<Released>& released() const { return released_; }
  Released& released(int joint) { return released_[joint]; }
  /// Per node: tangent-scaled rotation increments, and the inverse of their tangent.
  const std::vector<Vector3>& increments() const { return increments_; }
  const std::vector<Matrix3>& inverse_tangents() const { return inverse_tangents_; }
  /// The longest of the increments, tangent-scaled, and its node.
  struct LargestIncrement {
    double size = 0;
    int node = 0;
  };
  LargestIncrement largest_increment() const;
  /// The first hinge's coordinate that turns by more than half a turn, which the rotations of its nodes cannot tell
  /// from less; -1: none.
  int aliased_coordinate() const;
  /// Angle by which a coordinate that is no component of a rotation vector turns its joint [rad].
  double turn_of(const Coordinate& coordinate) const;
  StepMotion motion() const { return {*state_, begin_, end_, increments_, step_}; }
  /// True where a slider has left its line, or goes over more elements than a step may.
  bool is_off_line() const { return off_line_joint_ >= 0; }
  int off_line_joint() const { return off_line_joint_; }  ///< the first of those, -1: none
  /// True where a motion has driven it there, which no shorter step mends.
  bool is_driven_off_line() const;
  /// Notes when sliders that may leave their lines come to their ends.
  void note_events(FirstEvent& first) const;

  /// True where what acts in the balance is its mean over the step: in the Newmark family it is that at the end, of
  /// which there is none at the start of a simulation.
  bool forces_are_means() const { return scheme_.is_incremental() || state_->history.count == 0; }
  /// By which efforts on coordinates are multiplied in their rows. These are reactions, which schemes that interpolate
  /// forces in time extrapolate to the end of the step.
  double effort_weight() const;

  // ---- joints over the step
  bool has_incremental_joints() const { return scheme_.is_incremental(); }
  /// Increment of the released coordinates of a joint, and of one of them.
  ReleasedVector increment_of(int joint) const;
  double increment_of(const Coordinate& coordinate) const;
  /// Maps of a joint for residual `g` on its slave.
  void joint_maps(int joint, const Vector6& g, FoldMaps& maps, bool with_tangent) const;
  void joint_maps(int joint, const Vector6& g, SlideMaps& maps, bool with_tangent) const;
  MimicMap mimic_map(int coordinate) const;
  /// What passive efforts on a coordinate feel of the step.
  CoordinateStep coordinate_step(std::size_t coordinate, double increment) const;
  /// Released rates of a joint at the beginning; where they are kept, or found in this step.
  const ReleasedVector& begin_rates(int joint) const { return begin_rates_[joint]; }
  void find_begin_rates();
  /// Of one of them at the end, as the scheme makes it of the increment; where begin_rates() are known.
  double end_rate(const Coordinate& coordinate) const;
  /// Finds begin_rates() in every step, as the Newmark family does in any case.
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
  Eigen::VectorXd guess_;  // increments, one entry per unknown
  const State* state_ = nullptr;
  double step_ = 0;
  std::vector<NodePose> begin_, end_;
  std::vector<Released> released_;
  std::vector<slide::Place> begin_places_, end_places_;  // per joint, of sliders; empty without any
  std::vector<Vector3> increments_;
  std::vector<Matrix3> inverse_tangents_;
  int off_line_joint_ = -1;
  bool keeps_begin_rates_ = false;
  const EventModes* modes_ = nullptr;
  std::vector<Vector6> begin_velocities_;  // per node, spatial
  std::vector<ReleasedVector> begin_rates_;
};

}  // namespace flexarm
