#pragma once
/// Values that a simulation returns, in SI units.

#include <array>
#include <complex>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexarm/math/pose.h"

namespace flexarm {

/// Outcome of a step. Steps report failures by this value, not by exceptions.
struct StepResult {
  /// Why a step failed, see to_string().
  enum class Reason {
    None,
    NoConvergence,
    SingularTangent,
    NotFinite,
    RotationTooLarge,
    OffTheLine,
    DrivenOffTheLine,
    OpenLoop,
    NeverRests,
    BentTooFar,
    DeadPoint,
    OutOfTime,
    HitTooFast,
    EventWithin  ///< only in runs to an accuracy: an event lies within the step, which has to end there
  };

  /// A part of the mechanism; -1 means unknown.
  struct Place {
    int link = -1;                       ///< index into Simulation::link_names()
    int element = -1;                    ///< index of the element within a flexible link, from the start of the link
    int coordinate = -1;                 ///< index into Simulation::coordinate_names()
    int loop = -1;                       ///< index among the loops that joints without coordinates close
    Vector3 position = Vector3::Zero();  ///< world axes [m]
    int force_element = -1;              ///< index among the springs, tendons and contacts
    bool is_known() const { return link >= 0 || coordinate >= 0 || loop >= 0 || force_element >= 0; }
  };

  /// Where a step failed and what was tried; Simulation::explain() puts this into words.
  struct Failure {
    /// The meaning of `amount`.
    enum class Quantity {
      None,
      Force,     ///< largest unbalanced force [N]
      Moment,    ///< largest unbalanced moment [N m]
      Rotation,  ///< rotation of a link in the smallest sub-step [rad]
      Bending    ///< rotation between the nodes of an element [rad]
    };
    double time = 0;                 ///< start of the smallest sub-step [s]
    double step = 0;                 ///< length of the smallest sub-step [s]
    int guesses = 0;                 ///< number of initial guesses that were tried in this sub-step
    Reason cause = Reason::None;     ///< of the last attempt; differs from `reason` if that is OutOfTime
    bool tried_dissipation = false;  ///< the scheme edmc2 was tried too, and failed
    Place place;
    Quantity quantity = Quantity::None;
    double amount = 0;
  };

  bool converged = false;
  int iterations = 0;  ///< Newton iterations, summed over all sub-steps
  int factorisations = 0;

  // ---- recoveries: what the step needed to succeed
  int halvings = 0;            ///< how often a sub-step was halved
  int deepest_halving = 0;     ///< the shortest sub-step was 2^-deepest_halving of the step
  int other_guesses = 0;       ///< sub-steps that were solved from another initial guess than the first one
  bool is_dissipated = false;  ///< edmc2 did the step in place of the scheme, see OnFailure::Dissipate

  /// Largest estimated position error of a point after the step [m]; NaN if the run does not estimate it.
  double error_estimate = std::numeric_limits<double>::quiet_NaN();

  double largest_rotation = 0;   ///< largest rotation of a node in a sub-step, as 2 tan(angle/2)
  int turning_node = -1;         ///< the node with that rotation, < Simulation::node_count()
  Reason reason = Reason::None;  ///< why the step failed
  Failure failure;               ///< where the step failed

  /// Adds the iterations and recoveries of another attempt at the same step, or of an earlier part of it. The largest
  /// rotation is that of both.
  void add_effort(const StepResult& other);
};
/// Outcome of the search for an equilibrium.
struct StaticResult : StepResult {
  /// If the equilibrium to which the loads lead is not stable: the link that moves most as the mechanism leaves it.
  /// Otherwise empty.
  std::string falling_link;
  /// A link that could rest in other positions as well, such as one that turns on an upright hinge. Otherwise empty.
  std::string loose_link;
};
/// Which equilibrium solve_static() looks for.
enum class Equilibrium {
  Stable,  ///< the one to which the loads lead or, if that is not stable, one to which the mechanism falls from it
  UnderTheLoads  ///< the one to which the loads lead, stable or not
};
/// The reason in words.
const char* to_string(StepResult::Reason reason);

/// Sums of the counts of several steps.
struct StepCounts {
  long steps = 0, iterations = 0, halvings = 0, other_guesses = 0;
  long dissipated_steps = 0;  ///< steps that edmc2 did in place of the scheme
  int deepest_halving = 0;
  double error_estimate = std::numeric_limits<double>::quiet_NaN();  ///< of the last step with an estimate [m]

  void add(const StepResult& result);
};
/// The recoveries of steps in words: "3 halvings (down to 1/4 of a step), ...". Empty if there were none.
std::string recoveries_text(const StepCounts& counts);

/// Energies of a state [J]. Work and dissipation are integrals since the start. The potential energy is that of
/// gravity. Its zero level is the world's origin; for a mechanism far from there, the first joint on its root link; for
/// a floating mechanism, its initial position.
struct Energies {
  double kinetic = 0, strain = 0, potential = 0, work = 0, dissipated = 0;
  double total() const { return kinetic + strain + potential; }
};

/// One point of a deformed centreline. The centreline is the reference line of the sections; their centres of mass may
/// lie beside it.
struct BeamPoint {
  double arc_length = 0;                ///< along the undeformed line [m]
  Pose pose;                            ///< of the section, in the world; interpolated locally between nodes
  Vector6 strain = Vector6::Zero();     ///< {Gamma, K} in the section frame [-, 1/m], interpolated as in the scheme
  Vector6 resultant = Vector6::Zero();  ///< elastic {N, M} in the section frame, without damping [N, N m]
};

/// Upper bound of the von Mises strain in a section: as if bending and torsion were largest at the same point of its
/// edge, at the distance `radius` [m] from the centreline.
double edge_strain(const BeamPoint& point, double radius);

/// Pose and velocity of a named point.
struct ProbeState {
  Pose pose;
  // Of second order in the step, see Simulation::velocity.
  Vector3 velocity = Vector3::Zero();          ///< world axes [m/s]
  Vector3 angular_velocity = Vector3::Zero();  ///< world axes [rad/s]
};

/// Acceleration of a named point, from the motion over the last four steps. Oscillations with the period of two steps
/// cancel.
struct ProbeAcceleration {
  Vector3 linear = Vector3::Zero();   ///< world axes [m/s^2]
  Vector3 angular = Vector3::Zero();  ///< world axes [rad/s^2]
};

/// A force and a moment at a point.
struct Wrench {
  Vector3 force = Vector3::Zero();   ///< [N]
  Vector3 moment = Vector3::Zero();  ///< [N m]
};

/// A point where two bodies touch: two links, or a link and a ground.
struct ActingContact {
  std::string first, second;           ///< names, ordered as in the <contact>; without one, in the scene's order
  Vector3 position = Vector3::Zero();  ///< on the surface, in the world [m]
  Vector3 normal = Vector3::UnitZ();   ///< unit vector from the second body to the first, world axes
  Vector3 force = Vector3::Zero();     ///< on the first body, friction included, world axes [N]
  double penetration = 0;              ///< >= 0 [m]
};

/// A wrench and the point where it acts.
struct ActingWrench {
  Vector3 position = Vector3::Zero();  ///< in the world [m]
  Wrench wrench;                       ///< world axes, moment about `position`
};

/// A spring with a parallel damper between a point of a link and a place in the world. The spring has no force when the
/// point is at that place.
struct Pull {
  Vector3 target = Vector3::Zero();   ///< the place in the world [m]
  double stiffness = 0, damping = 0;  ///< [N/m], [N s/m]
  bool acts() const { return stiffness > 0 || damping > 0; }
};

/// A wrench on a link that the caller applies, in addition to the scene's loads.
struct AppliedWrench {
  std::size_t link = 0;          ///< in the order of the scene
  Vector3 at = Vector3::Zero();  ///< point of application, in the undeformed link's frame [m]
  Wrench wrench;                 ///< moment about that point
  bool follows = false;          ///< true: the axes turn with the link's material at that point; false: world axes
  Pull pull = {};                ///< acts on the same point, and follows its motion within each step
};

/// The quantity that a servo controls. Its set points are values of this quantity.
enum class ServoMode {
  Effort,  ///< the set point is the applied effort
  Velocity,
  Position
};

/// The name of a mode in scenes.
const char* to_string(ServoMode mode);
/// The mode with that name; empty if no mode has it.
std::optional<ServoMode> servo_mode_called(std::string_view name);

/// A new position and velocity for a joint coordinate. Values that are not given stay unchanged.
struct CoordinateState {
  std::size_t coordinate = 0;
  std::optional<double> position;  ///< [rad or m]
  std::optional<double> velocity;  ///< [rad/s or m/s]
};

/// A sample of a sensor, bias and noise included. It stays valid until the next sample.
struct SensorSample {
  static constexpr std::size_t kMostValues = 7;
  double time = -1;                             ///< time of the sample [s]; < 0: there is none yet
  std::array<double, kMostValues> values = {};  ///< in the order of scene::sensor_channels()
};

using ComplexVector6 = Eigen::Matrix<std::complex<double>, 6, 1>;

/// A motion of small amplitude, Re(shape exp((rate + 2 pi i frequency) t)). The shape is complex if nodes do not move
/// in phase: its real part is the shape at one instant. Minus its imaginary part is the shape a quarter of a period
/// later, apart from growth or decay.
struct Mode {
  double frequency = 0;                     ///< of the oscillation [Hz]; 0: no oscillation
  double rate = 0;                          ///< [1/s]; > 0: grows, < 0: decays, 0: neither, up to round-off
  std::vector<ComplexVector6> node_motion;  ///< {displacement, spin} of every node, world axes; largest component 1
  std::vector<std::complex<double>> coordinate_motion;  ///< of every coordinate [m, rad], same scaling as node_motion

  /// Whether nothing resists the motion: it continues at constant speed, or stands still.
  bool is_free() const { return frequency == 0 && rate == 0; }
  /// Whether it oscillates and grows.
  bool is_flutter() const { return rate > 0 && frequency > 0; }
  /// Whether it grows without oscillation.
  bool is_divergence() const { return rate > 0 && frequency == 0; }
  /// Damping relative to critical damping: 1 for decay without oscillation, < 0 for growth, 0 for a free motion.
  double damping_ratio() const;
};

}  // namespace flexarm
