#pragma once
/// Residual and tangent of one step (or of a static configuration) as a function of the trial end configuration.

#include <memory>
#include <vector>

#include "elements/momentum_beam.h"
#include "elements/nodal_inertia.h"
#include "elements/rotary_inertia.h"
#include "integrators/conserving_beams.h"
#include "integrators/conserving_nodes.h"
#include "integrators/friction_carrier.h"
#include "integrators/rotation_reference.h"
#include "integrators/scheme.h"
#include "joints/joint_forces.h"
#include "joints/joint_kinematics.h"
#include "model/degrees_of_freedom.h"
#include "model/model.h"
#include "model/state.h"
#include "solver/reduced_residual.h"
#include "solver/tangent_backend.h"

namespace flexarm {

/// A moment on a node at t_{n+1+alpha} from those at both ends, its derivative with respect to the one at the end, and
/// at constant moments with respect to the node's spin.
struct InterpolatedMoment {
  Vector3 value;
  Matrix3 slope, derivative;
};

/// Scratch and trial configuration of a step. Nothing allocates after construction.
///
/// Life of a step: begin(state, h), guess, then evaluate / update until converged, then accept(state).
class StepSystem {
 public:
  StepSystem(const Model& model, const Scheme& scheme, BackendChoice backend = BackendChoice::Fastest);

  enum class Guess {
    Extrapolated,  ///< from the last increments, see IncrementHistory; continuing the velocities in the first step
    Repeated,      ///< the last increments again
    Unchanged      ///< the configuration at the begin
  };

  // ---- dynamics
  /// Starts a step of length `step` [s] from `state`, which must outlive it. Prescribed coordinates take their end
  /// values.
  void begin(const State& state, double step, Guess guess);
  // ---- statics
  /// Starts from `state` with gravity and loads scaled by `load_factor`; histories and motions at time 0.
  void begin_static(const State& state, double load_factor);

  /// Assembles residual (and tangent) of the trial configuration. False if something is not finite.
  bool evaluate(bool with_tangent);
  /// Applies a Newton update (one entry per unknown) on the group; slaves follow their joints.
  void update(const Eigen::VectorXd& increment);
  /// After an evaluation at an updated configuration: decides anew which coordinates stick. True if that changes the
  /// equations.
  bool revise_friction();
  /// False if the tangent evaluated last had other coordinates stick.
  bool tangent_holds() const;
  /// Writes the trial configuration, evaluated last without an update since, as the new state.
  void accept(State& state);
  /// The same for statics: at rest.
  void accept_static(State& state);
  /// The state was changed by somebody else: quantities kept from the last step do not hold.
  void invalidate() { points_valid_ = false; }
  /// Adds to an initial state what the scheme keeps there.
  void initialise(State& state);

  /// True where a slider has left its line, or goes over more elements than a step may.
  bool is_off_line() const { return is_off_line_; }
  /// Length of the step under way [s]; 0 in statics.
  double step() const { return step_; }
  /// Largest violation of what the closures of loops imply, over the model's length scale and in rad: not zero where a
  /// loop was singular at the start.
  double open_loop() const;
  const Eigen::VectorXd& residual() const { return residual_; }
  TangentBackend& tangent() { return *backend_; }
  const TangentBackend& tangent() const { return *backend_; }
  const DegreesOfFreedom& degrees_of_freedom() const { return dof_; }
  /// Largest entry of an increment, displacements divided by the model's length scale [-, rad].
  double scaled_norm(const Eigen::VectorXd& increment) const;
  /// Largest rotation among them [rad].
  double largest_rotation(const Eigen::VectorXd& increment) const;
  /// Largest tangent-scaled rotation increment of a node over the step.
  double largest_node_rotation() const;

 private:
  StepMotion motion() const { return {*state_, begin_, end_, increments_, step_}; }
  void add_momentum_beams(bool with_tangent);
  void add_endpoint_forces(bool with_tangent);
  void add_newmark_inertia(bool with_tangent);
  template <int Nodes>
  void gather_nodes(const BeamElement<Nodes>& element, const std::vector<NodePose>& end,
                    ElementNodes<Nodes>& nodes) const;
  template <int Nodes>
  void scatter(const BeamElement<Nodes>& element, const ElementSystem<Nodes>& system, bool with_tangent);
  template <int Nodes>
  void interpolate_forces(const BeamElement<Nodes>& element, bool with_tangent, ElementSystem<Nodes>& system);
  template <int Nodes>
  void add_average_rotary(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, bool with_tangent,
                          ElementEnergy<Nodes>* energy, ElementSystem<Nodes>& system);
  template <int Nodes>
  void add_newmark_rotary(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, bool with_tangent,
                          ElementSystem<Nodes>& system);
  void add_nodal_forces(bool with_tangent);
  void add_nodal_force(int node, const Vector6& force, Eigen::Matrix<double, 6, 3> rotational, bool of_configuration,
                       bool with_tangent);
  void add_nodal_inertia(bool with_tangent);
  double load_time() const;
  void interpolate_configuration();
  InterpolatedMoment interpolated_moment(int node, const Vector3& begin, const Vector3& end,
                                         bool with_derivative) const;
  void add_interpolated_forces(bool with_tangent);
  void shift_reactions();
  void joint_maps(int joint, const Vector6& g, FoldMaps& maps, bool with_tangent) const;
  void slide_maps(int joint, const Vector6& g, SlideMaps& maps, bool with_tangent) const;
  ClosurePoses closure_poses(const LoopClosure& closure, const std::vector<NodePose>& nodes) const;
  void add_closures(bool with_tangent);
  void extrapolate_multipliers();
  void update_multipliers(const Eigen::VectorXd& increment);
  void accept_multipliers(State& state) const;
  void fold_joints(bool with_tangent);
  void add_joint_efforts(int joint, bool with_tangent);
  CoordinateStep coordinate_step(std::size_t index, double increment) const;
  void find_friction();
  void begin_friction();
  void add_normal_friction(int joint, const Vector6& g, FoldMaps& maps, bool with_tangent);
  void add_normal_friction(int joint, const Vector6& g, SlideMaps& maps, bool with_tangent);
  template <class AddDerivative>
  void turn_row(int joint, const Vector6& g, Eigen::Ref<Vector6> left, const AddDerivative& add_derivative,
                bool with_tangent);
  void add_constant_friction(int coordinate, double increment, double& row);
  double friction_direction(int coordinate) const;
  double travel_per_carrier(int coordinate) const;
  double increment_of(const Coordinate& coordinate) const;
  int equation_of(const Coordinate& coordinate) const;
  void hold_friction();
  void hold_friction_tangent();
  void place_held_coordinates();
  double smooth_rate(int coordinate) const;
  void remember_smooth_rates();
  void stop_smooth_reversals();
  void accept_friction(State& state) const;
  void compute_begin_rates();
  NodeStep node_step(std::size_t node) const;
  double effort_weight() const { return has_reactions() ? 1 / (1 - scheme_.alpha) : 1; }
  bool has_reactions() const { return is_interpolated() && !state_->reactions.empty(); }
  NewmarkRule newmark() const { return newmark_rule(scheme_, step_); }
  bool is_on_line(const JointMap& joint, int j) const;
  SlideTravel slide_travel(int joint) const;
  void fold_slide(int joint, bool with_tangent);
  MimicMap mimic_map(int coordinate) const;
  bool is_interpolated() const { return scheme_.hht != HhtForm::None && !static_; }
  void initialise_strain_memory(State& state);
  void initialise_momentum_rates(State& state);
  void load_begin_configuration(const State& state);
  void compute_begin_points();
  void set_prescribed(double time);
  void extrapolate(int order);
  void choose_order(IncrementHistory& history);
  void set_slaves();
  void update_increments();
  double work() const;
  double effort_at(const Coordinate& coordinate, std::size_t index) const;

  const Model& model_;
  Scheme scheme_;
  DegreesOfFreedom dof_;
  ReducedResidual rows_;
  std::unique_ptr<TangentBackend> backend_;

  const State* state_ = nullptr;
  double step_ = 0, load_factor_ = 1;
  bool static_ = false;
  std::vector<NodePose> begin_, end_;
  std::vector<Released> released_;
  std::vector<ReleasedVector> multipliers_;  // per closure
  std::vector<Vector3> increments_;          // per node, tangent-scaled
  std::vector<Matrix3> inverse_tangents_;
  RotationReference reference_;
  std::vector<PointKinematics> begin_points_, end_points_;  // unless in conserving_beams_
  ConservingBeams conserving_beams_;                        // empty for schemes of other families
  ConservingNodes conserving_nodes_;                        // the same
  std::vector<Matrix3> begin_mass_rotations_, end_mass_rotations_;
  std::vector<MassPointState> end_mass_points_;
  std::vector<Vector6> end_strain_rates_;
  std::vector<StrainMemory> end_strain_memory_;
  // Hilber-Hughes-Taylor family
  std::vector<NodePose> interpolated_;       // configuration at t_{n+1+alpha}
  std::vector<Matrix3> interpolated_spins_;  // spin there per spin at the end
  std::vector<Vector6> end_forces_, end_reactions_;
  std::vector<Vector3> end_momentum_rates_;
  std::vector<double> history_values_;        // at the scheme's point
  std::vector<double> begin_history_values_;  // at the begin; work of the Newmark family
  std::vector<double> applied_;               // per coordinate: effort in this step
  bool is_off_line_ = false;
  SlideMaps slide_maps_, friction_slide_maps_;
  std::vector<MimicMap> mimic_maps_;
  std::vector<Vector6> begin_velocities_;    // per node, spatial; Newmark family, sticking friction
  std::vector<ReleasedVector> begin_rates_;  // per joint; Newmark family, sticking friction
  std::vector<FrictionCarrier> carriers_;
  std::vector<int> carrier_of_;                      // per coordinate: index into carriers_, or -1
  std::vector<double> capacities_;                   // per coordinate: of its friction, from the force on the joint
  std::vector<StickSlip::Branch> tangent_branches_;  // per carrier, in the last tangent
  std::vector<int> smooth_coordinates_;              // with an unknown of their own and smooth friction
  int updates_ = 0;                                  // of this trial, by Newton's method
  std::vector<double> smooth_rates_;                 // theirs, before an update
  int revisions_ = 0;                                // of friction in this solve
  bool points_valid_ = false;
  double dissipated_ = 0;
  Eigen::VectorXd residual_;
};

}  // namespace flexarm
