#pragma once
/// The contents of a scene file as plain data: names, and numbers in SI units.

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/math/time_function.h"
#include "flexarm/model/results.h"
#include "flexarm/scene/beam_description.h"
#include "flexarm/scene/contact_description.h"
#include "flexarm/scene/force_element.h"
#include "flexarm/scene/joint_description.h"
#include "flexarm/scene/source_location.h"
#include "flexarm/scene/visual_description.h"
#include "flexarm/schemes/integrator_description.h"

namespace flexarm::scene {

// ---------------------------------------------------------------- links

/// URDF <inertial>: mass [kg], centre of mass in the link frame [m], inertia about that point in link axes [kg m^2].
struct RigidInertia {
  double mass = 0;
  Vector3 center_of_mass = Vector3::Zero();
  Matrix3 inertia = Matrix3::Zero();
  SourceLocation location = {};
};

/// The drag of air or another fluid at rest on a link: minus half the density, times speed, coefficient, area and
/// velocity, along each axis. Axes are those of the sections of a beam, or of a rigid link.
struct DragDescription {
  Vector3 coefficient;             ///< for flow along each axis [-]; along a beam: 0
  double density = 1.2;            ///< of the fluid [kg/m^3]
  std::optional<Vector3> area;     ///< that flow along each axis meets [m^2], for a beam per length [m]; a beam without
                                   ///< it has that of its section
  std::optional<Vector3> at = {};  ///< on a rigid link, in its frame [m]; empty: the centre of mass
  SourceLocation location = {};
};

struct LinkDescription {
  std::string name;
  std::optional<RigidInertia> inertial;  ///< ignored if there is a beam
  std::optional<BeamDescription> beam;
  std::vector<VisualDescription> visuals = {};     ///< shapes for display
  std::vector<VisualDescription> collisions = {};  ///< shapes for contact with other links and grounds
  SourceLocation location = {};
  std::optional<DragDescription> drag = {};
};

/// A cylinder that pushes and pulls between points of two links. The reader adds its parts to the scene (NAME: that of
/// the cylinder): the links NAME_barrel and NAME_rod; the joint NAME, whose position is the distance of the points; the
/// universal joint NAME_hinge and the spherical loop joint NAME_pin, which are hidden. They get their places where the
/// other joints place both links at the start, when a Simulation is made.
struct CylinderDescription {
  /// Barrel or rod, a solid cylinder about the line between the points, which begins at its own point [kg, m].
  struct Part {
    double mass = 0;
    std::optional<double> length, radius;  ///< empty: what looks well, and no size for the inertia
  };
  std::string name;
  std::string from, to;                                        ///< links that barrel and rod are hinged on
  Vector3 from_at = Vector3::Zero(), to_at = Vector3::Zero();  ///< in their undeformed frames [m]
  Part barrel, rod;
  SourceLocation location;
  std::string pump = {};  ///< coordinate that lets in oil: it starts with the length that the oil fills; empty: none
};

// ---------------------------------------------------------------- drives

/// A linear spring on a joint coordinate. It has no effort at the position `rest` [rad or m].
/// Stiffness [N m/rad or N/m].
struct SpringDescription {
  std::string coordinate;
  double stiffness = 0, rest = 0;
  SourceLocation location = {};
  /// Damping ratio of the vibration on this spring, with the inertia that the coordinate moves at the start while the
  /// joints farther out are free [-].
  double damping_ratio = 0;
};

/// Motor and gear of a joint coordinate. All numbers except the rotor's inertia are referred to the joint side of the
/// gear: rotor angles are divided by the gear ratio, and efforts multiplied by it.
struct DriveDescription {
  std::string coordinate;
  std::optional<double> gear;       ///< gear ratio: rotor angle per joint position [-, or rad/m]; empty: 1
  double rotor_inertia = 0;         ///< about the motor's axis [kg m^2]
  std::optional<double> stiffness;  ///< of the gear [N m/rad or N/m]; empty: rigid
  double damping = 0;               ///< of the elastic gear [N m s/rad or N s/m]
  /// An alternative to `damping`: damping ratio of the vibration on the elastic gear while the rotor is held, with the
  /// inertia that the coordinate moves at the start [-].
  double damping_ratio = 0;
  double backlash = 0;          ///< total play of the elastic gear [rad or m]
  double friction = 0;          ///< dry friction of the motor [N m or N]
  double efficiency = 1;        ///< of the gear, while the motor drives
  double effort_limit = 0;      ///< stall effort of the motor [N m or N]; 0: unlimited
  double velocity_limit = 0;    ///< no-load speed of the motor [rad/s or m/s]; 0: unlimited
  std::optional<Vector3> axis;  ///< rotor axis in the parent link's frame, unit; empty: no gyroscopic effect
  SourceLocation location;
};

/// Controller of a joint coordinate. Its output is the effort of the coordinate's motor.
struct ServoDescription {
  using Mode = ServoMode;
  enum class Side { Motor, Link };
  /// Gains for another mode. Programs can switch to this mode (Simulation::switch_mode).
  struct Gains {
    Mode mode = Mode::Velocity;
    double kp = 0, kd = 0, ki = 0, anti_windup = 0;  ///< as in ServoDescription
  };
  std::string coordinate;
  Mode mode = Mode::Position;
  double kp = 0, kd = 0, ki = 0;  ///< gains of the error of the controlled quantity, its rate and its integral
  /// Set point until a command arrives. Empty: the initial position of the coordinate; 0 in the other modes.
  std::optional<TimeFunction> set_point;
  std::optional<TimeFunction> feedforward;  ///< effort that is added [N m or N]
  double effort_limit = 0;                  ///< [N m or N]; 0: unlimited
  double anti_windup = 0;   ///< time constant of back-calculation while the effort is limited [s]; 0: none
  Side side = Side::Motor;  ///< the side of the gear where position and velocity are measured
  double sample_time = 0;   ///< [s]; 0: continuous
  double delay = 0;         ///< from a sample until its effort acts [s]
  std::vector<Gains> other_modes;
  SourceLocation location;
};

// ---------------------------------------------------------------- simulation

/// Initial position and velocity of a joint coordinate. `coordinate` is the joint's name. For a joint with several
/// coordinates, a suffix follows (see coordinate_suffixes).
struct InitialJoint {
  std::string coordinate;
  double position = 0, velocity = 0;
  SourceLocation location;
  bool gives_velocity = false;  ///< `velocity` is given even if 0; it then overrides the field of the child link
};

/// Initial velocity of a link as a rigid field, in world axes: v(x) = linear + angular x (x - link origin).
/// [m/s, rad/s]
struct InitialLink {
  std::string link;
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
  SourceLocation location;
};

enum class LoadFrame { World, Follower };

/// Point load on a link: `at` [m] in the undeformed link frame, force [N], moment [N m], scaled by history(t).
struct PointLoad {
  std::string link;
  Vector3 at = Vector3::Zero(), force = Vector3::Zero(), moment = Vector3::Zero();
  LoadFrame frame = LoadFrame::World;
  TimeFunction history;
  SourceLocation location;
};

/// Force per length [N/m] along a flexible link's centreline, between two arc lengths [m].
struct DistributedLoad {
  std::string link;
  Vector3 force = Vector3::Zero();
  LoadFrame frame = LoadFrame::World;
  TimeFunction history;
  SourceLocation location;
  std::optional<double> from = {}, to = {};  ///< arc lengths; empty: the ends of the centreline
};

/// Prescribed motion of a joint coordinate: position(t) [rad or m].
struct PrescribedMotion {
  std::string coordinate;
  TimeFunction position;
  SourceLocation location;
};

/// Effort on a joint coordinate until a command arrives: history(t) [N or N m].
struct JointEffort {
  std::string coordinate;
  TimeFunction history;
  SourceLocation location;
};

/// A named point of a link. Its pose and velocity are results. `at`: in the undeformed link frame [m].
struct Probe {
  std::string name, link;
  Vector3 at = Vector3::Zero();
  SourceLocation location;
};

enum class SensorKind {
  Wrench,        ///< force and moment by a joint on its link, about the sensor's position, in link axes
  Reaction,      ///< the same in world axes
  SectionForce,  ///< elastic force and moment in a flexible link's section, about the centreline, in section axes
  Strain,        ///< of a flexible link: axial strain of the fibre through the sensor's position
  Imu,           ///< angular velocity, and acceleration minus gravity, in axes that turn with the sensor
  Pose,          ///< of the sensor in the world
  Twist,         ///< velocity and angular velocity of the sensor, in world axes
  Contact,       ///< contact force and moment on the link or on `group`, about the sensor, in link axes
  Tendon         ///< length of a tendon, and its tension at the first guide
};

/// One number that a sensor measures: the last part of its column's name, and its unit.
struct SensorChannel {
  const char* name;
  const char* unit;
};
/// Where sensors of a kind measure: at a point of a link, in a joint that carries it, in a section of a beam, where
/// bodies touch, or in a tendon.
enum class SensedPlace { Point, Joint, Section, Touch, Tendon };
/// What all code but the measurement itself needs to know about a kind of sensors.
struct SensorTraits {
  const char* name;  ///< in the scene
  SensorKind kind;
  SensedPlace place;
  bool in_world;                        ///< vectors are along world axes; else along those of the link or sensor
  std::vector<SensorChannel> channels;  ///< the numbers that it measures, in the order of its samples
  /// Number of values in noise and bias. One for each channel; but six for a pose: position error [m] and rotation
  /// vector [rad], in the sensor's axes.
  std::size_t errors;
};
/// One row for each kind.
const std::vector<SensorTraits>& sensor_kinds();
const SensorTraits& traits_of(SensorKind kind);
inline const std::vector<SensorChannel>& sensor_channels(SensorKind kind) {
  return traits_of(kind).channels;
}

/// A sensor at a point of a link, with its own sample rate.
struct Sensor {
  std::string name;
  SensorKind kind = SensorKind::Pose;
  std::string link;   ///< Tendon: the link of the first guide
  std::string joint;  ///< Wrench, Reaction: name of a loop joint of the link; empty: the tree joint that carries it
  std::vector<std::string> group = {};  ///< Contact: measure the forces on these links and grounds; empty: on the link
  Vector3 at = Vector3::Zero();         ///< in the undeformed link frame [m]
  /// Sample rate [Hz]; 0: a sample in every step. A sample is taken at the end of the first step that reaches its time.
  double rate = 0;
  std::vector<double> noise, bias;  ///< standard deviation and mean of each error; empty: 0; one value: for all
  int seed = 0;                     ///< of the noise, in addition to the sensor's name
  SourceLocation location = {};
  std::string tendon = {};  ///< Tendon: its name
};

/// A named number that expressions of the scene use. The rest of this description was computed with its value.
struct ParameterDescription {
  std::string name;
  double value = 0;
  std::optional<double> min = {}, max = {};  ///< allowed values; empty: unbounded
};

/// A complete scene.
struct SceneDescription {
  std::string name;  ///< of the robot
  std::string file;
  std::string root_link;  ///< its frame is the world frame
  std::vector<LinkDescription> links;
  std::vector<JointDescription> joints;
  std::vector<JointDescription> loop_joints;   ///< close loops in the tree of `joints`
  std::vector<CylinderDescription> cylinders;  ///< whose parts have no places yet; a Simulation has none of these
  std::vector<SpringDescription> springs;
  std::vector<DriveDescription> drives;
  std::vector<ServoDescription> servos;
  Vector3 gravity = Vector3(0, 0, -9.81);  ///< [m/s^2]
  /// That undamped hits on stops, of contacts and in joints with play last, if these say nothing else [s].
  double contact_time = 0.01;
  IntegratorDescription integrator;
  SourceLocation integrator_location;  ///< line 0: the scene has no <integrator>
  std::vector<InitialJoint> initial_joints;
  std::vector<InitialLink> initial_links;
  std::vector<PointLoad> loads;
  std::vector<DistributedLoad> distributed_loads;
  std::vector<PrescribedMotion> motions;
  std::vector<JointEffort> efforts;
  std::vector<Probe> probes;
  std::vector<Sensor> sensors;
  ForceElementDescriptions force_elements;  ///< act between points of links, such as springs
  std::vector<GroundDescription> grounds;
  std::vector<ContactDescription> contacts;
  std::vector<ContactPair> no_contacts;
  std::map<std::string, SurfaceHints> surfaces;  ///< keyed by the name of the link; only links with hints
  std::vector<ClearanceDescription> clearances;  ///< joints with play
  bool lock_massless = false;          ///< hold joints that move no inertia at their start, instead of an error
  bool starts_in_equilibrium = false;  ///< start at rest in the equilibrium under loads, gravity and servos at t = 0
  SourceLocation equilibrium_location = {};      ///< of the <initial> element that requests this
  std::vector<ParameterDescription> parameters;  ///< in the order of the file
};

/// Limits of a joint coordinate, by its name. Null if it has none; coordinates such as "wrist/rx" have none.
const JointLimits* limits_of(const SceneDescription& scene, const std::string& coordinate);

/// Index of the first force element of a kind ("tendon") with a name; the number of force elements if there is none.
std::size_t find_force_element(const SceneDescription& scene, const std::string& kind, const std::string& name);

}  // namespace flexarm::scene
