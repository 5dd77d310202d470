#pragma once
/// The one façade of the core: load a scene, step it, look at it, reset it.

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
  /// Keep the factors of the tangent while the iteration contracts well (modified Newton). The result agrees with that
  /// of full Newton to far below the tolerance; off: quadratic convergence, and a restored state continues bit for bit.
  bool reuse_factorisation = true;
  std::optional<OnFailure> on_failure;
  /// Ends a step that has been halved after this time by the clock on the wall, with a reason of its own and the state
  /// after the last good sub-step, from which the next call goes on; 0: never [s]. Not negative.
  double recovery_wall_time = 0;
};

/// What a simulation was like at one time, to go back to it, or to show it to another thread: a value, cheap to copy.
class Snapshot {
 private:
  friend class Simulation;
  std::shared_ptr<State> state_;          // changed only by who holds it alone; null: nothing was taken yet
  std::shared_ptr<const State> initial_;  // of the simulation from which it is, and of its copies
};

/// A scene in motion. Simulations share nothing that changes: each may run in a thread of its own. What asks for a
/// coordinate, link or probe by its index throws std::out_of_range where there is none.
class Simulation {
 public:
  /// @throws ModelError if the scene cannot be built (unknown scheme, massless free link, ...), or is to start in
  /// equilibrium and has none.
  explicit Simulation(scene::SceneDescription scene, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  /// Another one of the same scene and settings, in the same state. Where one thread steps, another can look at a copy
  /// to which it restores the snapshots that it is handed (SpscRing): all looks have the same bits as at the original.
  Simulation copy() const;

  const scene::SceneDescription& scene() const;  ///< with the scheme and the step in use
  /// Warnings about the start that only the model can tell: joint coordinates that massless="lock" holds where they
  /// start because they move nothing that has inertia, in the scene's order; of a start in equilibrium, that this is
  /// not the one to which the loads lead, since it is not stable, or not the only one.
  const scene::Diagnostics& start_warnings() const;

  /// Advances by one step, in smaller sub-steps where Newton asks for it. On failure the state is that of the last good
  /// sub-step. Allocates nothing after its first call, but when a slider enters another element of its line.
  StepResult step();
  /// Why a step has failed: what, at which element or joint, where and when, what was tried, and what usually helps.
  /// One sentence for each, in one line. Empty if it has not failed.
  /// @throws std::invalid_argument if its place is none of this scene: it is the result of another simulation.
  std::string explain(const StepResult& result) const;
  /// Back to the scene's initial state; commands are forgotten.
  void reset();
  Snapshot snapshot() const;
  /// The same in the memory of an earlier snapshot, if that has no copies: nothing is allocated then.
  void snapshot(Snapshot& snapshot) const;
  /// Back to what it was like then, commands included.
  /// @throws std::invalid_argument if the snapshot is empty, or another scene's or scheme's.
  void restore(const Snapshot& snapshot);

  /// Goes on from where another one is, commands and wrenches included, of the same scene but for its <integrator>, its
  /// gravity and the gains of its servos. Joints and links stand and move as they did; what the energy of this state
  /// changes by, gravity's above all, counts as work.
  /// @throws std::invalid_argument if it is not the same mechanism, or something pulls on it (apply_wrenches) and the
  /// scheme has no pulls; nothing has changed then.
  void take_over(const Simulation& other);

  double time() const;       ///< [s]
  double step_size() const;  ///< [s]
  /// The length of steps from the next one on, [s], of scene(), too; the motion goes on from where it is, with all that
  /// the scheme conserves. What a scheme was made with for another step, as its numerical dissipation, stays. Snapshots
  /// do not have it.
  /// @throws std::invalid_argument if it is not > 0 and at most 1e9, or does not divide the sample time of a servo.
  void set_step_size(double step);
  double tolerance() const;  ///< of Newton's method, see IntegratorDescription
  /// From the next step on.
  /// @throws std::invalid_argument if it is not > 0 and at most kLargestTolerance.
  void set_tolerance(double tolerance);
  std::string scheme() const;  ///< name of the scheme in use

  /// Puts joint coordinates elsewhere at once, or gives them other velocities; what hangs on them is moved with them as
  /// it is, with its strains, twists of gears and their rates, its own joints' positions and velocities. Time, commands
  /// and memories of servos stay. What that changes of the energy counts as work, so that the account goes on.
  /// @throws std::invalid_argument if a number is not finite, a position beyond its limits, a coordinate named twice,
  /// prescribed or a follower, a loop opens, or accelerations cannot be found (Newmark); nothing has changed then.
  void set_joint_state(const std::vector<CoordinateState>& coordinates);

  // ---- released coordinates: one per scalar joint, several for the others ("wrist/rx")
  const std::vector<std::string>& coordinate_names() const;
  std::optional<std::size_t> find_coordinate(std::string_view name) const;
  double position(std::size_t coordinate) const;  ///< [rad or m]
  /// Rate at time(), of second order and without what rings in the scheme's own velocities (theory.md, "Published
  /// velocities and efforts") [rad/s or m/s].
  double velocity(std::size_t coordinate) const;
  /// Effort applied in the last step; where a motion is prescribed, what drives it at time(), of second order [N or N
  /// m].
  double effort(std::size_t coordinate) const;
  /// Commands an effort [N or N m] from the next step on, in place of the scene's <effort>; saturates at the joint's
  /// effort limit.
  /// @throws std::invalid_argument if it is not finite, or the coordinate not commandable.
  void command_effort(std::size_t coordinate, double effort);
  /// Back to the scene's <effort> history (zero where there is none).
  void release_command(std::size_t coordinate);
  /// Gives the coordinate's servo a set point [rad, m, rad/s, m/s, N or N m, as its mode says] from the next step on,
  /// in place of the scene's. One that moves is given as it is at the end of the next step, with its rate and its
  /// acceleration there [over s and s^2]; it comes to a stand then if no other follows.
  /// @throws std::invalid_argument if it is not finite, or the coordinate has no servo.
  void command_set_point(std::size_t coordinate, double set_point, double rate = 0, double acceleration = 0);
  /// What the coordinate's servo is asked for at the end of the next step.
  /// @throws std::invalid_argument if the coordinate has no servo.
  double set_point(std::size_t coordinate) const;
  /// Back to the scene's set point and mode.
  void release_set_point(std::size_t coordinate);
  /// Switches the coordinate's servo off or on, from the next step on. Off, its motor gives no effort, commanded ones
  /// included; on again, it has no memory in its integral. Set points stay as they are.
  /// @throws std::invalid_argument if the coordinate has no servo.
  void switch_servo(std::size_t coordinate, bool on);
  bool has_servo(std::size_t coordinate) const;
  /// Lets the coordinate's servo control something else, from the next step on, without a bump: its set point is the
  /// position, velocity or effort of now, its integral goes on from that effort; without one the set point is off it.
  /// @throws std::invalid_argument if the coordinate has no servo, or that no gains of this mode (`<gains>`).
  void switch_mode(std::size_t coordinate, ServoMode mode);
  /// @throws std::invalid_argument if the coordinate has no servo.
  ServoMode servo_mode(std::size_t coordinate) const;
  bool is_commandable(std::size_t coordinate) const;  ///< false for prescribed and mimic coordinates

  /// Applies wrenches from the next step on, in place of all that were applied before; none: takes these away. They
  /// belong to the state: snapshots and checkpoints have them, reset() forgets them. A point of a flexible link is
  /// carried by the section of the nearest node.
  /// @throws std::invalid_argument if one is not finite, its spring's constants are negative, its link is fixed to the
  /// world, or it pulls and the scheme interpolates forces in time (hht1, hht2, hht3); nothing has changed then.
  void apply_wrenches(const std::vector<AppliedWrench>& wrenches);

  // ---- frames: every link, in the scene's order
  const std::vector<std::string>& link_names() const;
  Pose link_pose(std::size_t link) const;    ///< in the world (= root link) frame
  bool is_flexible(std::size_t link) const;  ///< it has a beam with elements
  /// End section of a beam in the world, axes as the link's in the undeformed state; else the link's pose.
  Pose tip_pose(std::size_t link) const;
  /// Points at every node and `between` equally spaced points inside each pair of nodes; appended to `points`. Of a
  /// beam without elements those where the nodes of elements="auto" would be: nothing is known of their resultants,
  /// which are NaN.
  /// @throws std::invalid_argument if `between` is negative; so does undeformed_sections().
  void beam_points(std::size_t link, int between, std::vector<BeamPoint>& points) const;
  /// The sections of the same points while the link is undeformed, in the link's frame; none: the link has no beam.
  std::vector<Pose> undeformed_sections(std::size_t link, int between) const;
  /// Largest distance of the section's edge from the centreline, for display [m]; 0: the link has no beam.
  double beam_radius(std::size_t link) const;
  /// No motion moves it: nothing can be applied to it.
  bool is_fixed_to_world(std::size_t link) const;

  // ---- observables
  Energies energies() const;
  Vector3 momentum() const;                   ///< world axes [kg m/s]
  Vector3 angular_momentum() const;           ///< about the world origin [kg m^2/s]
  ProbeState probe(std::size_t index) const;  ///< in the order of scene().probes
  Pose probe_pose(std::size_t index) const;   ///< the same without what velocities cost
  /// Of second order in the step from the fourth step on; zero before the second one.
  ProbeAcceleration probe_acceleration(std::size_t index) const;
  /// The section of a flexible link at an arc length of its undeformed line [m]: pose, strain, section force.
  /// @throws std::invalid_argument if the link is rigid, or its line not as long.
  BeamPoint section(std::size_t link, double arc_length) const;
  /// What the joint of the tree that carries a link does to it, its drive and friction included: about the link's
  /// origin, world axes, of second order in the step from the third step on. It is kept for links of which a sensor of
  /// the scene asks it (kind Reaction or Wrench), and zero before the first step. What loop joints do is in samples.
  /// @throws std::invalid_argument if none does.
  Wrench reaction(std::size_t link) const;
  /// What such a sensor measures now, without errors: about its place, world axes.
  /// @throws std::invalid_argument if it measures something else.
  ActingWrench sensed_wrench(std::size_t sensor) const;
  /// Per coordinate, effort() as a force or a moment upon what it moves, at the moved joint frame. Replaces `wrenches`.
  void effort_wrenches(std::vector<ActingWrench>& wrenches) const;
  /// What acts upon points of links from outside at time(): the scene's loads, lumped at nodes where they are
  /// distributed, then what is applied, pulls included. Replaces `wrenches`.
  void outside_wrenches(std::vector<ActingWrench>& wrenches) const;
  /// Where links touch each other and grounds now, by a <contact> of the scene or within a joint with play. Replaces
  /// `contacts`.
  void contacts(std::vector<ActingContact>& contacts) const;
  double mass() const;  ///< of all that moves [kg]
  /// What a sensor has measured last, in the order of scene().sensors.
  const SensorSample& sample(std::size_t sensor) const;

  /// Statics: loads and gravity grow from zero in `load_steps` equal steps; prescribed motions are held at t = 0,
  /// other released coordinates are solved for. On success the state is the equilibrium, at rest; else it is as before.
  /// @throws std::invalid_argument if `load_steps` < 1.
  StaticResult solve_static(int load_steps, Equilibrium wanted = Equilibrium::Stable);

  /// Modes about the current configuration, taken to be at rest: growing ones first, then by |lambda|.
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
