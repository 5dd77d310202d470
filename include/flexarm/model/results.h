#pragma once
/// Results of a simulation: values, in SI units.

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

/// Outcome of a step; a value, never an exception.
struct StepResult {
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
    EventWithin  ///< only within runs to an accuracy: the step is to end at the event
  };

  /// A part of the mechanism; -1 stands for unknown.
  struct Place {
    int link = -1;                       ///< index into Simulation::link_names()
    int element = -1;                    ///< of that link if it is flexible, counted from its beginning
    int coordinate = -1;                 ///< index into Simulation::coordinate_names()
    int loop = -1;                       ///< of those that a joint without coordinates closes
    Vector3 position = Vector3::Zero();  ///< world axes [m]
    bool is_known() const { return link >= 0 || coordinate >= 0 || loop >= 0; }
  };

  /// Where a step failed and what was tried, as numbers; Simulation::explain() puts them into words.
  struct Failure {
    /// What `amount` is.
    enum class Quantity {
      None,
      Force,     ///< largest force that is not in balance [N]
      Moment,    ///< the same [N m]
      Rotation,  ///< of a link in the smallest sub-step [rad]
      Bending    ///< rotation within an element [rad]
    };
    double time = 0;                 ///< at the beginning of the smallest sub-step [s]
    double step = 0;                 ///< length of that [s]
    int guesses = 0;                 ///< from which Newton's method was started in it
    Reason cause = Reason::None;     ///< of the last attempt; differs from `reason` if that is OutOfTime
    bool tried_dissipation = false;  ///< edmc2 was tried instead of the scheme, in vain
    Place place;
    Quantity quantity = Quantity::None;
    double amount = 0;
  };

  bool converged = false;
  int iterations = 0;  ///< Newton iterations of all sub-steps
  int factorisations = 0;

  // ---- what was needed if it did not succeed at once
  int halvings = 0;            ///< times that a sub-step had to be halved
  int deepest_halving = 0;     ///< the shortest sub-step was 2^-deepest_halving of the step
  int other_guesses = 0;       ///< sub-steps that were solved from another guess than the first
  bool is_dissipated = false;  ///< the step was done by edmc2, OnFailure::Dissipate

  /// Largest error of the positions of points after the step [m], if the run estimates it; else NaN.
  double error_estimate = std::numeric_limits<double>::quiet_NaN();

  double largest_rotation = 0;   ///< of a node in a sub-step, as 2 tan(angle/2)
  int turning_node = -1;         ///< of Simulation::node_count(): which one
  Reason reason = Reason::None;  ///< why it failed
  Failure failure;               ///< where; of a step that failed
};
/// Outcome of the search for an equilibrium.
struct StaticResult : StepResult {
  /// The link that moves most as the mechanism leaves the equilibrium to which the loads lead. Empty if that is stable.
  std::string falling_link;
  /// A link that may stand elsewhere as well, as on an upright hinge. Empty if there is none.
  std::string loose_link;
};
/// Which equilibrium is asked for.
enum class Equilibrium {
  Stable,  ///< that to which the loads lead or, where this is not stable, one to which the mechanism falls from it
  UnderTheLoads  ///< that to which the loads lead, stable or not
};
/// The reason in words.
const char* to_string(StepResult::Reason reason);

/// Sums over steps.
struct StepCounts {
  long steps = 0, iterations = 0, halvings = 0, other_guesses = 0;
  long dissipated_steps = 0;  ///< done by edmc2
  int deepest_halving = 0;
  double error_estimate = std::numeric_limits<double>::quiet_NaN();  ///< of the last step that has one [m]

  void add(const StepResult& result);
};
/// What steps needed to succeed: "3 halvings (down to 1/4 of a step), ...". Empty if they needed nothing.
std::string recoveries_text(const StepCounts& counts);

/// Energies of a state [J]. Work and dissipation are integrals since the start. The potential is that of gravity. It is
/// zero at the world's origin; for a mechanism far from there, at the first joint on its root link, or, if it floats,
/// where it starts.
struct Energies {
  double kinetic = 0, strain = 0, potential = 0, work = 0, dissipated = 0;
  double total() const { return kinetic + strain + potential; }
};

/// One point of a deformed centreline, the reference line of the sections (not of their centres of mass).
struct BeamPoint {
  double arc_length = 0;                ///< of the undeformed line [m]
  Pose pose;                            ///< of the section, in the world; between nodes by the local interpolation
  Vector6 strain = Vector6::Zero();     ///< {Gamma, K} in the section frame [-, 1/m], by the scheme's interpolation
  Vector6 resultant = Vector6::Zero();  ///< {N, M} in the section frame [N, N m], elastic: without damping
};

/// The von Mises strain at the edge of a section, `radius` [m] from its middle, as if bending and torsion were largest
/// at the same point.
double edge_strain(const BeamPoint& point, double radius);

/// Pose and velocity of a named point.
struct ProbeState {
  Pose pose;
  // Of second order in the step, see Simulation::velocity.
  Vector3 velocity = Vector3::Zero();          ///< world axes [m/s]
  Vector3 angular_velocity = Vector3::Zero();  ///< the same [rad/s]
};

/// Acceleration of a named point, from the motion over the last four steps; oscillations from step to step cancel.
struct ProbeAcceleration {
  Vector3 linear = Vector3::Zero();   ///< world axes [m/s^2]
  Vector3 angular = Vector3::Zero();  ///< the same [rad/s^2]
};

/// A force and a moment at a point.
struct Wrench {
  Vector3 force = Vector3::Zero();   ///< [N]
  Vector3 moment = Vector3::Zero();  ///< [N m]
};

/// A point where two bodies touch: two links, or a link and a ground.
struct ActingContact {
  std::string first, second;           ///< their names; as its <contact> names them, else in the scene's order
  Vector3 position = Vector3::Zero();  ///< on the surface, in the world [m]
  Vector3 normal = Vector3::UnitZ();   ///< unit, from the second to the first, world axes
  Vector3 force = Vector3::Zero();     ///< on the first, friction included, world axes [N]
  double penetration = 0;              ///< >= 0 [m]
};

/// A wrench and the point where it acts.
struct ActingWrench {
  Vector3 position = Vector3::Zero();  ///< in the world [m]
  Wrench wrench;                       ///< about that, world axes
};

/// A spring, with a damper beside it, between a point of a link and a place in the world; slack if they coincide.
struct Pull {
  Vector3 target = Vector3::Zero();   ///< the place [m]
  double stiffness = 0, damping = 0;  ///< [N/m], [N s/m]
  bool acts() const { return stiffness > 0 || damping > 0; }
};

/// A wrench on a link from outside, in addition to the scene's loads.
struct AppliedWrench {
  std::size_t link = 0;          ///< in the order of the scene
  Vector3 at = Vector3::Zero();  ///< where: in the undeformed link's frame [m]
  Wrench wrench;                 ///< moment about that point
  bool follows = false;          ///< axes are those of the link's material there, and turn with it; else the world's
  Pull pull = {};                ///< acts on the point, too, and follows the motion within each step
};

/// What a servo controls; its set points are of this kind.
enum class ServoMode {
  Effort,  ///< the set point is the effort
  Velocity,
  Position
};

/// The name of a mode in scenes.
const char* to_string(ServoMode mode);
/// The mode of that name; empty if there is none.
std::optional<ServoMode> servo_mode_called(std::string_view name);

/// A wanted position and velocity of a joint coordinate; what is not given stays as it is.
struct CoordinateState {
  std::size_t coordinate = 0;
  std::optional<double> position;  ///< [rad or m]
  std::optional<double> velocity;  ///< [rad/s or m/s]
};

/// A sample of a sensor, with bias and noise. It holds until the next sample.
struct SensorSample {
  static constexpr std::size_t kMostValues = 7;
  double time = -1;                             ///< when; < 0: never [s]
  std::array<double, kMostValues> values = {};  ///< as scene::sensor_channels() has them
};

using ComplexVector6 = Eigen::Matrix<std::complex<double>, 6, 1>;

/// A motion Re(shape exp((rate + 2 pi i frequency) t)) of small amplitude. The shape is complex if nodes do not move in
/// phase: it is the real part now, and minus the imaginary part a quarter of a period later, apart from growth or
/// decay.
struct Mode {
  double frequency = 0;                     ///< of the oscillation [Hz]; 0: none
  double rate = 0;                          ///< [1/s]; > 0: grows, < 0: decays, 0: neither, up to round-off
  std::vector<ComplexVector6> node_motion;  ///< {displacement, spin} of every node, world axes; largest component 1
  std::vector<std::complex<double>> coordinate_motion;  ///< of every coordinate [m, rad], in the same units

  /// Nothing resists the motion: it goes on at constant speed, or stands still.
  bool is_free() const { return frequency == 0 && rate == 0; }
  /// Oscillates and grows.
  bool is_flutter() const { return rate > 0 && frequency > 0; }
  /// Grows without oscillation.
  bool is_divergence() const { return rate > 0 && frequency == 0; }
  /// Relative to critical damping: 1 if it decays without oscillation, < 0 if it grows, 0 for a free motion.
  double damping_ratio() const;
};

}  // namespace flexarm
