#pragma once
/// The main interface of the library: make a simulation of a scene, step it, read its state, reset it.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/model/model_error.h"
#include "flexarm/model/results.h"
#include "flexarm/scene/diagnostic.h"
#include "flexarm/schemes/integrator_description.h"

namespace flexarm {

namespace scene {
struct SceneDescription;  // flexarm/scene/scene_description.h
}
struct State;

/// Options that override the scene's <integrator>.
struct SimulationOptions {
  std::optional<std::string> scheme;
  std::optional<double> step;  ///< [s]
  std::optional<double> tolerance;
  /// Reuse a factorisation of the tangent while the iteration converges well (modified Newton). The result differs from
  /// that of full Newton by far less than the tolerance. If off, convergence is quadratic, and a run that continues
  /// from a restored state is the same bit for bit.
  bool reuse_factorisation = true;
  std::optional<OnFailure> on_failure;
  /// Time limit [s] of wall time, >= 0; 0: none. A step that had to be halved is aborted after this time, with
  /// StepResult::Reason::OutOfTime. The state is then that after the last good sub-step, and the next call continues
  /// there.
  double recovery_wall_time = 0;
};

/// The state of a simulation at one time, to restore it later or in another thread. Cheap to copy.
class Snapshot {
 private:
  friend class Simulation;
  std::shared_ptr<State> state_;          // changed only while nobody shares it; null: empty snapshot
  std::shared_ptr<const State> initial_;  // initial state of the simulation, which identifies it and its copies
};

/// A scene in motion. Simulations share no mutable data: each may run in a thread of its own. Functions that take the
/// index of a coordinate, link or probe throw std::out_of_range if there is none.
class Simulation {
 public:
  /// @throws ModelError if the scene cannot be built (unknown scheme, massless free link, ...), or if it has to start
  /// in equilibrium and none is found.
  explicit Simulation(scene::SceneDescription scene, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  /// Another simulation of the same scene and settings, in the same state. To read a simulation that another thread
  /// steps, read a copy: restore the snapshots that arrive through an SpscRing. All values have the same bits as in the
  /// original.
  Simulation copy() const;

  const scene::SceneDescription& scene() const;  ///< with the scheme and the step that are in use
  /// Warnings about the start that need the model. First, in the scene's order: joint coordinates that move no inertia
  /// and are therefore held at their start (massless="lock"). Then, for a start in equilibrium: that the equilibrium to
  /// which the loads lead is not stable and another one was taken, or that the equilibrium is not unique.
  const scene::Diagnostics& start_warnings() const;

  /// Advances by one step, in smaller sub-steps if Newton's method needs them. After a failure the state is that after
  /// the last good sub-step. After the first call, steps allocate memory only when a slider enters another element, and
  /// when elements of a beam with refine="true" are halved or joined.
  StepResult step();
  /// Explains why a step failed: the reason, at which element or joint, where and when, what was tried, and what
  /// usually helps. The result is one line with several sentences. Empty if the step did not fail.
  /// @throws std::invalid_argument if the result is that of another simulation, so that its place is not in this scene.
  std::string explain(const StepResult& result) const;
  /// Returns to the scene's initial state and forgets all commands.
  void reset();
  Snapshot snapshot() const;
  /// As snapshot(), but reuses the memory of an earlier snapshot if that has no copies. It then allocates no memory.
  void snapshot(Snapshot& snapshot) const;
  /// Returns to the state of the snapshot, commands included.
  /// @throws std::invalid_argument if the snapshot is empty, or from another scene or scheme.
  void restore(const Snapshot& snapshot);

  /// Continues from the state of another simulation, commands and wrenches included. The scenes may differ only in
  /// <integrator>, gravity and gains of servos. Joints and links keep their positions and velocities. The change of
  /// their energy, mostly due to gravity, counts as work.
  /// @throws std::invalid_argument if the mechanisms differ, or if the other simulation has pulls (apply_wrenches) and
  /// this scheme does not support them. The simulation is then unchanged.
  void take_over(const Simulation& other);

  double time() const;       ///< [s]
  double step_size() const;  ///< [s]
  /// Sets the step size of the next steps, and of scene() [s]. The motion goes on: no energy or momentum changes.
  /// Constants that a scheme computed from its first step size, such as numerical dissipation, do not change. Snapshots
  /// do not contain the step size.
  /// @throws std::invalid_argument if it is not > 0 and at most 1e9, or does not divide the sample time of a servo.
  void set_step_size(double step);
  double tolerance() const;  ///< of Newton's method, see IntegratorDescription
  /// Sets the tolerance from the next step on.
  /// @throws std::invalid_argument if it is not > 0 and at most kLargestTolerance.
  void set_tolerance(double tolerance);
  std::string scheme() const;  ///< name of the scheme in use

  /// Sets positions or velocities of joint coordinates at once. Everything that these joints carry moves along
  /// unchanged: strains, deflections of gears and their rates, positions and velocities of other joints. Time, commands
  /// and memories of servos stay. The change of energy counts as work, so that the energy balance stays valid.
  /// @throws std::invalid_argument if a number is not finite, a position is beyond its limits, a coordinate appears
  /// twice, is prescribed or follows another one, a loop opens, or accelerations cannot be found (schemes of the
  /// Newmark family). The simulation is then unchanged.
  void set_joint_state(const std::vector<CoordinateState>& coordinates);

  // ---- joint coordinates: one per scalar joint, several for other joints ("wrist/rx")
  const std::vector<std::string>& coordinate_names() const;
  std::optional<std::size_t> find_coordinate(std::string_view name) const;
  double position(std::size_t coordinate) const;  ///< [rad or m]
  /// Rate at time() [rad/s or m/s]. It has second-order accuracy, without the oscillations of the scheme's own
  /// velocities (docs/theory/time_integration.md, "Published velocities and efforts").
  double velocity(std::size_t coordinate) const;
  /// Effort that was applied in the last step [N or N m]. For a prescribed coordinate: the effort that drives the
  /// motion at time(), with second-order accuracy.
  double effort(std::size_t coordinate) const;
  /// Commands an effort from the next step on, which replaces the scene's <effort> [N or N m]. It is clamped to the
  /// joint's effort limit.
  /// @throws std::invalid_argument if it is not finite, or if the coordinate accepts no commands.
  void command_effort(std::size_t coordinate, double effort);
  /// Withdraws the command: the scene's <effort> applies again (zero if there is none).
  void release_command(std::size_t coordinate);
  /// Gives the coordinate's servo a set point from the next step on, which replaces that of the scene [rad, m, rad/s,
  /// m/s, N or N m, according to its mode]. For a moving set point, give its values at the end of the next step: set
  /// point, rate and acceleration [per s and s^2]. Without another command the set point stays there.
  /// @throws std::invalid_argument if it is not finite, or the coordinate has no servo.
  void command_set_point(std::size_t coordinate, double set_point, double rate = 0, double acceleration = 0);
  /// The set point of the coordinate's servo at the end of the next step.
  /// @throws std::invalid_argument if the coordinate has no servo.
  double set_point(std::size_t coordinate) const;
  /// Withdraws the command: the scene's set point and mode apply again.
  void release_set_point(std::size_t coordinate);
  /// Switches the coordinate's servo off or on, from the next step on. A servo that is off gives no effort, not even a
  /// commanded one. When it is switched on, its integral starts at zero. Set points are kept.
  /// @throws std::invalid_argument if the coordinate has no servo.
  void switch_servo(std::size_t coordinate, bool on);
  bool has_servo(std::size_t coordinate) const;
  /// Changes the mode of the coordinate's servo from the next step on, without a jump in its effort. The set point
  /// becomes the present position, velocity or effort. The integral is set so that the effort is continuous; without an
  /// integral, the set point is shifted for this purpose.
  /// @throws std::invalid_argument if the coordinate has no servo, or if the servo has no <gains> for this mode.
  void switch_mode(std::size_t coordinate, ServoMode mode);
  /// @throws std::invalid_argument if the coordinate has no servo.
  ServoMode servo_mode(std::size_t coordinate) const;
  bool is_commandable(std::size_t coordinate) const;  ///< false for prescribed and mimic coordinates

  /// Applies these wrenches from the next step on. They replace all earlier ones; an empty list removes them. They are
  /// part of the state: snapshots and checkpoints contain them, reset() removes them. On a flexible link a wrench acts
  /// on the section of the nearest node.
  /// @throws std::invalid_argument if a wrench is not finite, a stiffness or damping is negative, the link is fixed to
  /// the world, or a wrench has a pull and the scheme interpolates forces in time (hht1, hht2, hht3). Nothing has
  /// changed then.
  void apply_wrenches(const std::vector<AppliedWrench>& wrenches);

  // ---- links, in the scene's order
  const std::vector<std::string>& link_names() const;
  Pose link_pose(std::size_t link) const;    ///< in the world (= root link) frame
  bool is_flexible(std::size_t link) const;  ///< whether it has a beam with elements
  /// Pose of a beam's end section in the world. In the undeformed state its axes are the link's axes. For links without
  /// a beam, the link's pose.
  Pose tip_pose(std::size_t link) const;
  /// Appends points of a beam to `points`: one at every node, and `between` equally spaced points between neighbouring
  /// nodes. For a rigid beam, the nodes are those that elements="auto" would create, and resultants, which are unknown,
  /// are NaN.
  /// @throws std::invalid_argument if `between` is negative. undeformed_sections() throws the same.
  void beam_points(std::size_t link, int between, std::vector<BeamPoint>& points) const;
  /// Poses of the same sections in the undeformed link, in the link's frame. Empty if the link has no beam.
  std::vector<Pose> undeformed_sections(std::size_t link, int between) const;
  /// Largest distance of the section's contour from the centreline, for display [m]; 0 if the link has no beam.
  double beam_radius(std::size_t link) const;
  /// Whether the link never moves. Wrenches cannot be applied to such a link.
  bool is_fixed_to_world(std::size_t link) const;

  // ---- observables
  Energies energies() const;
  Vector3 momentum() const;                   ///< world axes [kg m/s]
  Vector3 angular_momentum() const;           ///< about the world origin [kg m^2/s]
  ProbeState probe(std::size_t index) const;  ///< in the order of scene().probes
  Pose probe_pose(std::size_t index) const;   ///< the same pose, without the cost of the velocities
  /// Of second order in the step, from the fourth step on; zero before the second step.
  ProbeAcceleration probe_acceleration(std::size_t index) const;
  /// The section of a flexible link at an arc length of its undeformed centreline [m]: pose, strain, internal force.
  /// @throws std::invalid_argument if the link is rigid, or the arc length is beyond its end.
  BeamPoint section(std::size_t link, double arc_length) const;
  /// Force and moment on a link by the tree joint that carries it, drive and friction included; about the link's
  /// origin, in world axes. Of second order in the step from the third step on, zero before the first step. Known only
  /// for links with a sensor of kind Reaction or Wrench. For loop joints use sensed_wrench().
  /// @throws std::invalid_argument if there is no such sensor.
  Wrench reaction(std::size_t link) const;
  /// The present value of a sensor that measures a force and a moment, without its errors: about its position, world
  /// axes.
  /// @throws std::invalid_argument if the sensor measures something else.
  ActingWrench sensed_wrench(std::size_t sensor) const;
  /// For each coordinate, effort() as a force or moment on the link that it moves, at the moved joint frame. Overwrites
  /// `wrenches`.
  void effort_wrenches(std::vector<ActingWrench>& wrenches) const;
  /// External wrenches on points of links at time(): first the scene's loads (distributed loads as forces on nodes),
  /// then applied wrenches and pulls. Overwrites `wrenches`.
  void outside_wrenches(std::vector<ActingWrench>& wrenches) const;
  /// The points where links touch each other or a ground now, because of a <contact> or in a joint with play.
  /// Overwrites `contacts`.
  void contacts(std::vector<ActingContact>& contacts) const;
  /// Overwrites `points` by those of the line along which a spring between points or a tendon acts now, in the order of
  /// scene().force_elements: world axes [m]. Arcs on pulleys have several points. Their number may change with time.
  void line_points(std::size_t element, std::vector<Vector3>& points) const;
  /// The largest number of points that line_points() may give.
  std::size_t most_line_points(std::size_t element) const;
  double mass() const;  ///< total mass of all moving parts [kg]
  /// The last sample of a sensor, in the order of scene().sensors.
  const SensorSample& sample(std::size_t sensor) const;

  /// Finds an equilibrium. Loads and gravity grow from zero in `load_steps` equal steps. Prescribed motions are held at
  /// t = 0; all other coordinates are unknowns. On success the state is the equilibrium, at rest. After a failure the
  /// state is unchanged.
  /// @throws std::invalid_argument if `load_steps` < 1.
  StaticResult solve_static(int load_steps, Equilibrium wanted = Equilibrium::Stable);

  /// Computes `count` modes about the present configuration, as if it were at rest. Growing modes come first, then
  /// modes in ascending order of |eigenvalue|.
  /// @throws std::invalid_argument if `count` < 1; std::runtime_error if the eigenvalue problem cannot be solved.
  std::vector<Mode> natural_modes(int count) const;

  std::size_t node_count() const;          ///< changes when elements are halved or joined
  std::size_t degrees_of_freedom() const;  ///< unknowns of the Newton iteration

 private:
  struct Implementation;
  explicit Simulation(std::unique_ptr<Implementation> implementation);
  friend struct Inside;  // src/simulation/inside.h
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flexarm
