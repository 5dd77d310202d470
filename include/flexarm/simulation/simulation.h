#pragma once
/// The interface of the library: make a simulation of a scene, step it, read its state, reset it.

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
  /// Keep the factors of the tangent while the iteration converges well (modified Newton). The result agrees with that
  /// of full Newton to far below the tolerance. If off: quadratic convergence, and a restored state continues bit for
  /// bit.
  bool reuse_factorisation = true;
  std::optional<OnFailure> on_failure;
  /// Wall time after which a step that had to be halved is given up [s], with a reason of its own. The state is then
  /// that after the last good sub-step, from which the next call goes on. 0: never. Not negative.
  double recovery_wall_time = 0;
};

/// The state of a simulation at one time, to go back to it, or to hand it to another thread. A value that is cheap to
/// copy.
class Snapshot {
 private:
  friend class Simulation;
  std::shared_ptr<State> state_;          // changed only by who holds it alone; null: nothing was taken yet
  std::shared_ptr<const State> initial_;  // of the simulation from which it is, and of its copies
};

/// A scene in motion. Simulations share nothing that changes: each may run in a thread of its own. Functions that take
/// the index of a coordinate, link or probe throw std::out_of_range if there is none.
class Simulation {
 public:
  /// @throws ModelError if the scene cannot be built (unknown scheme, massless free link, ...), or if it is to start in
  /// equilibrium and has no equilibrium.
  explicit Simulation(scene::SceneDescription scene, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  /// Another simulation of the same scene and settings, in the same state. While one thread steps, another thread can
  /// read a copy, to which it restores the snapshots that it gets (SpscRing): every value has the same bits as that of
  /// the original.
  Simulation copy() const;

  const scene::SceneDescription& scene() const;  ///< with the scheme and the step in use
  /// Warnings about the start that need the model. First, in the scene's order, joint coordinates that massless="lock"
  /// holds where they start, because they move nothing with inertia. Then, for a start in equilibrium, that it is not
  /// the one to which the loads lead, since that one is not stable, or that it is not the only one.
  const scene::Diagnostics& start_warnings() const;

  /// Advances by one step, in smaller sub-steps if Newton's method needs them. On failure the state is that of the last
  /// good sub-step. After its first call it allocates memory only when a slider enters another element of its line.
  StepResult step();
  /// Why a step failed: what, at which element or joint, where and when, what was tried, and what usually helps; a
  /// sentence for each, in one line. Empty if the step did not fail.
  /// @throws std::invalid_argument if the result is that of another simulation, since its place is not in this scene.
  std::string explain(const StepResult& result) const;
  /// Back to the scene's initial state; commands are forgotten.
  void reset();
  Snapshot snapshot() const;
  /// The same. It reuses the memory of an earlier snapshot if that has no copies; then it allocates nothing.
  void snapshot(Snapshot& snapshot) const;
  /// Goes back to the state of the snapshot, commands included.
  /// @throws std::invalid_argument if the snapshot is empty, or that of another scene or scheme.
  void restore(const Snapshot& snapshot);

  /// Goes on from the state of another simulation, commands and wrenches included. Its scene is the same except for
  /// <integrator>, gravity and gains of servos. Joints and links keep their positions and velocities; the change of
  /// their energy, by gravity above all, counts as work.
  /// @throws std::invalid_argument if it is not the same mechanism, or if something pulls on it (apply_wrenches) and
  /// the scheme has no pulls. Then nothing has changed.
  void take_over(const Simulation& other);

  double time() const;       ///< [s]
  double step_size() const;  ///< [s]
  /// Sets the length of the steps from the next one on, also in scene() [s]. The motion goes on, with everything that
  /// the scheme conserves. Constants that a scheme took from the first step, such as its numerical dissipation, stay.
  /// Snapshots do not contain the step size.
  /// @throws std::invalid_argument if it is not > 0 and at most 1e9, or does not divide the sample time of a servo.
  void set_step_size(double step);
  double tolerance() const;  ///< of Newton's method, see IntegratorDescription
  /// From the next step on.
  /// @throws std::invalid_argument if it is not > 0 and at most kLargestTolerance.
  void set_tolerance(double tolerance);
  std::string scheme() const;  ///< name of the scheme in use

  /// Gives joint coordinates other positions or velocities at once. Everything that hangs on them is moved along
  /// unchanged: strains, twists of gears and their rates, positions and velocities of its own joints. Time, commands
  /// and memories of servos stay. The change of energy counts as work, so that the energy account goes on.
  /// @throws std::invalid_argument if a number is not finite, a position is beyond its limits, a coordinate is named
  /// twice, prescribed or a follower, a loop opens, or accelerations cannot be found (Newmark). Then nothing has
  /// changed.
  void set_joint_state(const std::vector<CoordinateState>& coordinates);

  // ---- released coordinates: one per scalar joint, several for the others ("wrist/rx")
  const std::vector<std::string>& coordinate_names() const;
  std::optional<std::size_t> find_coordinate(std::string_view name) const;
  double position(std::size_t coordinate) const;  ///< [rad or m]
  /// Rate at time() [rad/s or m/s]. It is of second order, and free of the oscillations of the scheme's own velocities
  /// (docs/theory/time_integration.md, "Published velocities and efforts").
  double velocity(std::size_t coordinate) const;
  /// Effort applied in the last step; for a prescribed motion the effort that drives it at time(), of second order [N
  /// or N m].
  double effort(std::size_t coordinate) const;
  /// Commands an effort from the next step on, instead of the scene's <effort> [N or N m]. It is cut at the joint's
  /// effort limit.
  /// @throws std::invalid_argument if it is not finite, or if the coordinate takes no commands.
  void command_effort(std::size_t coordinate, double effort);
  /// Goes back to the scene's <effort> (zero if there is none).
  void release_command(std::size_t coordinate);
  /// Gives the coordinate's servo a set point from the next step on, instead of the scene's [rad, m, rad/s, m/s, N or N
  /// m, according to its mode]. A moving set point is given as it is at the end of the next step, with its rate and
  /// acceleration there [per s and s^2]; if no other command follows it stops there.
  /// @throws std::invalid_argument if it is not finite, or the coordinate has no servo.
  void command_set_point(std::size_t coordinate, double set_point, double rate = 0, double acceleration = 0);
  /// The set point of the coordinate's servo at the end of the next step.
  /// @throws std::invalid_argument if the coordinate has no servo.
  double set_point(std::size_t coordinate) const;
  /// Goes back to the scene's set point and mode.
  void release_set_point(std::size_t coordinate);
  /// Switches the coordinate's servo off or on, from the next step on. While it is off its motor gives no effort, not
  /// even a commanded one. When it is switched on its integral is empty. Set points stay as they are.
  /// @throws std::invalid_argument if the coordinate has no servo.
  void switch_servo(std::size_t coordinate, bool on);
  bool has_servo(std::size_t coordinate) const;
  /// Changes the mode of the coordinate's servo from the next step on, without a jump in its effort. The set point
  /// becomes the present position, velocity or effort, and the integral continues the effort; without an integral the
  /// set point is shifted to do so.
  /// @throws std::invalid_argument if the coordinate has no servo, or if the servo has no gains for this mode
  /// (`<gains>`).
  void switch_mode(std::size_t coordinate, ServoMode mode);
  /// @throws std::invalid_argument if the coordinate has no servo.
  ServoMode servo_mode(std::size_t coordinate) const;
  bool is_commandable(std::size_t coordinate) const;  ///< false for prescribed and mimic coordinates

  /// Applies these wrenches from the next step on, instead of all that were applied before; an empty list removes them.
  /// They are part of the state: snapshots and checkpoints contain them, reset() removes them. On a flexible link a
  /// wrench acts through the section of the nearest node.
  /// @throws std::invalid_argument if a wrench is not finite, the constants of its spring are negative, its link is
  /// fixed to the world, or it pulls and the scheme interpolates forces in time (hht1, hht2, hht3). Then nothing has
  /// changed.
  void apply_wrenches(const std::vector<AppliedWrench>& wrenches);

  // ---- frames: every link, in the scene's order
  const std::vector<std::string>& link_names() const;
  Pose link_pose(std::size_t link) const;    ///< in the world (= root link) frame
  bool is_flexible(std::size_t link) const;  ///< it has a beam with elements
  /// Pose of a beam's end section in the world; in the undeformed state its axes are the link's. For other links, the
  /// link's pose.
  Pose tip_pose(std::size_t link) const;
  /// Appends to `points` a point at every node and `between` equally spaced points between each pair of nodes. For a
  /// beam without elements they are where the nodes of elements="auto" would be, and their resultants, which are not
  /// known, are NaN.
  /// @throws std::invalid_argument if `between` is negative, as undeformed_sections() does.
  void beam_points(std::size_t link, int between, std::vector<BeamPoint>& points) const;
  /// Poses of the same sections in the undeformed link, in the link's frame. Empty if the link has no beam.
  std::vector<Pose> undeformed_sections(std::size_t link, int between) const;
  /// Largest distance of the section's edge from the centreline, for display [m]; 0 if the link has no beam.
  double beam_radius(std::size_t link) const;
  /// Whether the link never moves. Nothing can be applied to it then.
  bool is_fixed_to_world(std::size_t link) const;

  // ---- observables
  Energies energies() const;
  Vector3 momentum() const;                   ///< world axes [kg m/s]
  Vector3 angular_momentum() const;           ///< about the world origin [kg m^2/s]
  ProbeState probe(std::size_t index) const;  ///< in the order of scene().probes
  Pose probe_pose(std::size_t index) const;   ///< the same without what velocities cost
  /// Of second order in the step from the fourth step on; zero before the second step.
  ProbeAcceleration probe_acceleration(std::size_t index) const;
  /// The section of a flexible link at an arc length of its undeformed line [m]: pose, strain, internal force.
  /// @throws std::invalid_argument if the link is rigid, or its line is not that long.
  BeamPoint section(std::size_t link, double arc_length) const;
  /// Force and moment on a link by the joint of the tree that carries it, with drive and friction: about the link's
  /// origin, world axes, of second order in the step from the third step on, zero before the first step. Known only for
  /// links with a sensor of kind Reaction or Wrench. Sensors have the wrenches of loop joints.
  /// @throws std::invalid_argument if there is no such sensor.
  Wrench reaction(std::size_t link) const;
  /// What such a sensor measures now, without its errors: about its place, world axes.
  /// @throws std::invalid_argument if it measures something else.
  ActingWrench sensed_wrench(std::size_t sensor) const;
  /// For each coordinate effort() as a force or moment on the link that it moves, at the moved joint frame. Replaces
  /// `wrenches`.
  void effort_wrenches(std::vector<ActingWrench>& wrenches) const;
  /// What acts on points of links from outside at time(): the loads of the scene (distributed ones as forces on nodes),
  /// then applied wrenches and pulls. Replaces `wrenches`.
  void outside_wrenches(std::vector<ActingWrench>& wrenches) const;
  /// The points where links touch each other or a ground now, by a <contact> of the scene or in a joint with play.
  /// Replaces `contacts`.
  void contacts(std::vector<ActingContact>& contacts) const;
  double mass() const;  ///< of all that moves [kg]
  /// The last sample of a sensor, in the order of scene().sensors.
  const SensorSample& sample(std::size_t sensor) const;

  /// Finds an equilibrium. Loads and gravity grow from zero in `load_steps` equal steps; prescribed motions are held at
  /// t = 0; all other coordinates are solved for. On success the state is the equilibrium, at rest; otherwise it is as
  /// before.
  /// @throws std::invalid_argument if `load_steps` < 1.
  StaticResult solve_static(int load_steps, Equilibrium wanted = Equilibrium::Stable);

  /// Modes about the present configuration, as if it were at rest: growing ones first, then by |lambda|.
  /// @throws std::invalid_argument if `count` < 1; std::runtime_error if the eigenvalue problem cannot be solved.
  std::vector<Mode> natural_modes(int count) const;

  std::size_t node_count() const;
  std::size_t degrees_of_freedom() const;  ///< unknowns of the Newton iteration

 private:
  struct Implementation;
  explicit Simulation(std::unique_ptr<Implementation> implementation);
  friend struct Inside;  // simulation/inside.h, beside the source
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flexarm
