#pragma once
/// The contents of a scene file: names and numbers in SI units.

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "flexarm/math/cam_profile.h"
#include "flexarm/math/pose.h"
#include "flexarm/math/time_function.h"
#include "flexarm/model/results.h"
#include "flexarm/scene/contact_description.h"
#include "flexarm/scene/force_element.h"
#include "flexarm/scene/source_location.h"
#include "flexarm/scene/visual_description.h"
#include "flexarm/schemes/integrator_description.h"

namespace flexarm::scene {

// ---------------------------------------------------------------- beams

/// Solid circular section. [m]
struct Circle {
  double radius;
};
/// Circular tube. [m]
struct Tube {
  double outer_radius, inner_radius;
};
/// Solid rectangle: width along the section's y axis, height along z. [m]
struct Rectangle {
  double width, height;
};
/// Thin-walled rectangular box: outer width along y, outer height along z, wall thickness. [m]
struct BoxTube {
  double width, height, thickness;
};
/// Isotropic material: Young's modulus [Pa], Poisson ratio, density [kg/m^3].
struct Material {
  double young, poisson, density;
};

using SectionShape = std::variant<Circle, Tube, Rectangle, BoxTube>;
/// A section given by its geometry and its material.
struct GeometricSection {
  SectionShape shape;
  Material material;
};
/// Section stiffnesses and inertias about principal axes; 1 = tangent, 2 = y, 3 = z.
/// ea, ga2, ga3 [N]; gj, ei2, ei3 [N m^2]; mass [kg/m]; j1, j2, j3 [kg m].
struct DirectSection {
  double ea, ga2, ga3, gj, ei2, ei3, mass, j1, j2, j3;
};
/// Full section matrices in the section frame, order {force 1 2 3, moment 1 2 3}; stiffness symmetric positive
/// definite; inertia [[m 1, -m d^], [m d^, J]] with d the centre of mass in the section.
struct MatrixSection {
  Matrix6 stiffness, inertia;
};

using UniformSection = std::variant<GeometricSection, DirectSection, MatrixSection>;

/// A section that changes along the line: linear between stations in the shape's lengths, or in stiffnesses and
/// inertias, and constant before the first and beyond the last.
struct SectionStations {
  std::vector<double> arc_lengths;       ///< ascending, at least two [m]
  std::vector<UniformSection> sections;  ///< as many, all of one kind; shapes of one kind and one material
};

using Section = std::variant<GeometricSection, DirectSection, MatrixSection, SectionStations>;

/// One piece of the centreline in the link frame; starts where the piece before ended (the first at the link origin).
struct CentrelinePiece {
  enum class Kind { Line, Arc };
  Kind kind = Kind::Line;
  Vector3 to = Vector3::Zero();      ///< end point [m]
  Vector3 center = Vector3::Zero();  ///< arc only: its centre [m]; the shorter arc is meant
  double twist = 0;                  ///< pre-twist of the section over this piece [rad]
  SourceLocation location;
};

/// Rigid inertia on one end of a beam, such as a drive's housing or a flange.
struct HubDescription {
  enum class End { Start, End };
  End end = End::Start;
  double mass = 0;                    ///< at the centreline [kg]
  Vector3 inertia = Vector3::Zero();  ///< about the link's axes, through the centreline's end [kg m^2]
  SourceLocation location;
};

struct BeamDescription {
  std::optional<int> elements;  ///< number of elements; empty: "auto"; 0: it is rigid
  int order = 2;                ///< 1..4, nodes per element minus one
  std::vector<CentrelinePiece> centreline;
  std::optional<Vector3> section_y;  ///< the section's y axis at s = 0, in the link frame; empty: chosen reproducibly
  Section section;
  double stiffness_proportional_damping = 0;  ///< of the strain that is damped most [s]
  /// Of it, what the strains have: axial, shear y z, torsion, bending y z; at most 1.
  Vector6 damping_shares = Vector6::Ones();
  double mass_proportional_damping = 0;  ///< [1/s]
  /// Strains at which it is free of stress: axial, shear y z [-], torsion, bending y z [1/m]; empty: zero.
  std::array<std::optional<TimeFunction>, 6> prestrain;
  std::vector<HubDescription> hubs;  ///< at most one at each end
  SourceLocation location;
};

// ---------------------------------------------------------------- links and joints

/// URDF <inertial>: mass [kg], centre of mass in the link frame [m], inertia about it in link axes [kg m^2].
struct RigidInertia {
  double mass = 0;
  Vector3 center_of_mass = Vector3::Zero();
  Matrix3 inertia = Matrix3::Zero();
  SourceLocation location = {};
};

struct LinkDescription {
  std::string name;
  std::optional<RigidInertia> inertial;  ///< ignored where there is a beam
  std::optional<BeamDescription> beam;
  std::vector<VisualDescription> visuals = {};     ///< read where there is a beam: of other links others draw them
  std::vector<VisualDescription> collisions = {};  ///< shapes by which it touches others
  SourceLocation location = {};
};

enum class JointKind {
  Fixed,
  Revolute,
  Continuous,
  Prismatic,
  Planar,
  Floating,
  Spherical,
  Universal,
  Cylindrical,
  // One coordinate, an angle about `axis`, on which a travel depends:
  Screw,
  RackAndPinion,
  Worm,
  Cam,
  Slide  ///< along the parent's flexible centreline: arc length, then what SlideDescription::rotation releases
};

/// Screw, rack and pinion, worm, cam.
constexpr bool has_dependent_travel(JointKind kind) {
  return kind == JointKind::Screw || kind == JointKind::RackAndPinion || kind == JointKind::Worm ||
         kind == JointKind::Cam;
}

struct JointLimits {
  double lower, upper;                     ///< position [rad or m]
  double velocity = 0;                     ///< kept, not enforced
  std::optional<double> restitution = {};  ///< of the stops, from 0.05 to 1; empty: 0.3
};

struct Mimic {
  std::string joint;
  double multiplier = 1, offset = 0;
};

struct SlideDescription {
  enum class End {
    Stop,   ///< a unilateral stop with restitution
    Error,  ///< the step fails
    Free    ///< what slides leaves the line and flies on
  };
  double start = 0;  ///< initial arc length [m]
  /// Fixed, Revolute, Universal, Spherical, or a kind with dependent travel: then the arc length is `start` + travel.
  JointKind rotation = JointKind::Spherical;
  End on_end = End::Stop;                  ///< what the ends of the line are
  std::string scheme = "sm_em";            ///< how the contact is carried over a step (docs/schemes.md)
  bool smooth = true;                      ///< tangents of the line are continuous over the borders of elements
  Vector3 offset = Vector3::Zero();        ///< rigid segment from the line to the joint, in the joint's frame [m]
  std::optional<double> restitution = {};  ///< of the stops, from 0.05 to 1; empty: 0.3
  SourceLocation location = {};
};

/// Dry friction of a joint's released coordinates, besides the constant effort of <dynamics friction>.
struct FrictionDescription {
  enum class Law {
    Smooth,  ///< F tanh(rate / v)
    Coulomb  ///< set-valued: sticks exactly
  };
  Law law = Law::Smooth;
  double coefficient = 0;  ///< of the force normal to the travel, or across the axis [-]
  double radius = 0;       ///< at which it acts on rotations: of the bearing [m]
};

struct JointDescription {
  std::string name;
  JointKind kind = JointKind::Fixed;
  std::string parent, child;         ///< link names
  Pose origin;                       ///< joint frame in the parent link frame
  Vector3 axis = Vector3::UnitX();   ///< unit vector in the joint frame (planar: the normal)
  Vector3 axis2 = Vector3::UnitY();  ///< universal: second axis, unit, in the joint frame turned by the first angle
  // Joints with dependent travel
  double ratio = 0;   ///< travel per angle: pitch, radius of the pinion, ratio of the worm [m/rad]
  double offset = 0;  ///< worm: of the moved axis from the joint's origin, along direction x axis [m]
  Vector3 direction = Vector3::UnitX();       ///< of the travel, unit, in the joint frame; a screw's is its axis
  std::shared_ptr<const CamProfile> profile;  ///< cam: travel over the angle
  std::optional<SlideDescription> slide;      ///< of JointKind::Slide
  std::optional<JointLimits> limits;  ///< only where positions are limited (revolute, prismatic, dependent travel)
  double effort_limit = 0;            ///< commanded efforts saturate here, any kind [N or N m]; 0: unlimited
  double damping = 0;                 ///< per released coordinate [N s/m or N m s/rad]
  double friction = 0;                ///< Coulomb effort per released coordinate [N or N m]
  FrictionDescription friction_law;
  std::optional<Mimic> mimic;
  Pose child_origin;  ///< loop joints: joint frame in the child link frame
  SourceLocation location;
};

/// Play of a joint: contact at the end of the play holds what the joint would hold. A joint of the tree is then a
/// floating one; a loop joint is nothing but these contacts.
struct ClearanceDescription {
  JointDescription joint;  ///< without play: revolute, continuous, prismatic or spherical
  bool closes_loop = false;
  double radius = 0;                     ///< the play: by which the hole is larger than what is in it [m]
  std::optional<double> length = {};     ///< of the pin or block along the axis [m]; empty: see docs/scene_format.md
  std::optional<double> width = {};      ///< of the block's square section [m]; empty: as its length
  double journal = 0;                    ///< radius of the pin or ball; 0: without friction it does not count [m]
  std::optional<double> stiffness = {};  ///< of a contact point [N/m]; empty: by what it moves and the step
  double restitution = 0.3;              ///< from 0.05 to 1
  double friction = 0;                   ///< Coulomb's coefficient
  SourceLocation location = {};          ///< of <clearance>
};

// ---------------------------------------------------------------- drives

/// A linear spring on a joint's coordinate, slack at `rest` [rad or m]; stiffness [N m/rad or N/m].
struct SpringDescription {
  std::string coordinate;
  double stiffness = 0, rest = 0;
  SourceLocation location = {};
  double damping_ratio = 0;  ///< of what the coordinate moves at the start, joints outboard of it free [-]
};

/// Motor and gear of a joint's coordinate. All numbers except the rotor's inertia are those at the joint: angles of the
/// rotor divided by the gear ratio, efforts multiplied by it.
struct DriveDescription {
  std::string coordinate;
  std::optional<double> gear;       ///< rotor's angle per position of the coordinate [-, or rad/m]; empty: 1
  double rotor_inertia = 0;         ///< about the motor's axis [kg m^2]
  std::optional<double> stiffness;  ///< of the gear [N m/rad or N/m]; empty: rigid
  double damping = 0;               ///< of the elastic gear [N m s/rad or N s/m]
  double damping_ratio = 0;         ///< the same, of what the coordinate moves at the start, the rotor held [-]
  double backlash = 0;              ///< whole play of the elastic gear [rad or m]
  double friction = 0;              ///< of the motor [N m or N]
  double efficiency = 1;            ///< of the gear, when the motor drives
  double effort_limit = 0;          ///< of the motor at rest [N m or N]; 0: unlimited
  double velocity_limit = 0;        ///< no-load speed of the motor [rad/s or m/s]; 0: unlimited
  std::optional<Vector3> axis;      ///< of the rotor in the parent link's frame, unit; empty: without gyroscopic effect
  SourceLocation location;
};

/// Controller of a joint's coordinate; its effort is the motor's.
struct ServoDescription {
  using Mode = ServoMode;
  enum class Side { Motor, Link };
  /// Gains of another mode, to which programs may switch.
  struct Gains {
    Mode mode = Mode::Velocity;
    double kp = 0, kd = 0, ki = 0, anti_windup = 0;  ///< as below
  };
  std::string coordinate;
  Mode mode = Mode::Position;
  double kp = 0, kd = 0, ki = 0;            ///< of the error of what `mode` names, its rate and its integral
  std::optional<TimeFunction> set_point;    ///< before a command arrives; empty: where the coordinate starts, or 0
  std::optional<TimeFunction> feedforward;  ///< added effort [N m or N]
  double effort_limit = 0;                  ///< [N m or N]; 0: unlimited
  double anti_windup = 0;   ///< time in which the integral follows a saturated effort [s]; 0: it does not
  Side side = Side::Motor;  ///< where it measures
  double sample_time = 0;   ///< [s]; 0: continuous
  double delay = 0;         ///< from a sample to its effect [s]
  std::vector<Gains> other_modes;
  SourceLocation location;
};

// ---------------------------------------------------------------- simulation

/// Initial position and velocity of a released coordinate. `coordinate` is a joint's name, or for a joint with several
/// coordinates its name with a suffix (see coordinate_suffixes).
struct InitialJoint {
  std::string coordinate;
  double position = 0, velocity = 0;
  SourceLocation location;
  bool gives_velocity = false;  ///< where it is 0: the joint is at rest, whatever field its child link has
};

/// Initial rigid velocity field of a link, world axes: v(x) = linear + angular x (x - link origin). [m/s, rad/s]
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

/// Force per length [N/m] along a flexible link's centreline, between two arc lengths of it [m].
struct DistributedLoad {
  std::string link;
  Vector3 force = Vector3::Zero();
  LoadFrame frame = LoadFrame::World;
  TimeFunction history;
  SourceLocation location;
  std::optional<double> from = {}, to = {};  ///< empty: the ends of the line
};

/// Prescribed released coordinate, position(t) [rad or m].
struct PrescribedMotion {
  std::string coordinate;
  TimeFunction position;
  SourceLocation location;
};

/// Joint effort before any command arrives, effort(t) [N or N m].
struct JointEffort {
  std::string coordinate;
  TimeFunction history;
  SourceLocation location;
};

/// A named point of a link whose pose and velocity are put out.
struct Probe {
  std::string name, link;
  Vector3 at = Vector3::Zero();
  SourceLocation location;
};

enum class SensorKind {
  Wrench,        ///< what a joint does to its link, in the link's axes about the sensor's place
  Reaction,      ///< the same in world axes
  SectionForce,  ///< of a flexible link: elastic force and moment in the section's axes, about its reference line
  Strain,        ///< of a flexible link: of the fibre through the sensor's place, along the line
  Imu,           ///< angular velocity, and acceleration less gravity, in axes that turn with the sensor's place
  Pose,          ///< in the world
  Contact        ///< what others do to the link, or to a group, by touching it: in the link's axes about the place
};

/// One number that a sensor measures: the last part of its name, and its unit.
struct SensorChannel {
  const char* name;
  const char* unit;
};
/// What a sensor of that kind measures, in this order.
const std::vector<SensorChannel>& sensor_channels(SensorKind kind);
/// Number of a sensor's errors: one for each channel, but six for a pose (three of the place [m], three of the rotation
/// vector [rad], in the sensor's axes).
std::size_t sensor_error_count(SensorKind kind);

/// Measures at a point of a link, at its own rate.
struct Sensor {
  std::string name;
  SensorKind kind = SensorKind::Pose;
  std::string link;
  std::string joint;  ///< Wrench, Reaction: a loop joint of the link; empty: the joint that carries it
  std::vector<std::string> group = {};  ///< Contact: links and grounds that are touched; empty: the link
  Vector3 at = Vector3::Zero();         ///< in the undeformed link frame [m]
  double rate = 0;  ///< samples per second, each at the end of the first step that reaches it [Hz]; 0: every step
  std::vector<double> noise, bias;  ///< standard deviations and means of the errors; empty: none, one: all alike
  int seed = 0;                     ///< of the noise, besides the sensor's name
  SourceLocation location = {};
};

/// A number that expressions of the scene use; everything else in the description was made with its value.
struct ParameterDescription {
  std::string name;
  double value = 0;
  std::optional<double> min = {}, max = {};  ///< what it may be set to; empty: anything
};

struct SceneDescription {
  std::string name;  ///< of the robot
  std::string file;
  std::string root_link;  ///< its name is the world frame's
  std::vector<LinkDescription> links;
  std::vector<JointDescription> joints;
  std::vector<JointDescription> loop_joints;  ///< close loops of the tree that `joints` form
  std::vector<SpringDescription> springs;
  std::vector<DriveDescription> drives;
  std::vector<ServoDescription> servos;
  Vector3 gravity = Vector3(0, 0, -9.81);  ///< [m/s^2]
  IntegratorDescription integrator;
  SourceLocation integrator_location;  ///< without line: the scene has no <integrator>
  std::vector<InitialJoint> initial_joints;
  std::vector<InitialLink> initial_links;
  std::vector<PointLoad> loads;
  std::vector<DistributedLoad> distributed_loads;
  std::vector<PrescribedMotion> motions;
  std::vector<JointEffort> efforts;
  std::vector<Probe> probes;
  std::vector<Sensor> sensors;
  ForceElementDescriptions force_elements;  ///< what acts between points of links: springs
  std::vector<GroundDescription> grounds;
  std::vector<ContactDescription> contacts;
  std::vector<ContactPair> no_contacts;
  std::map<std::string, SurfaceHints> surfaces;  ///< of links that have some, by their names
  std::vector<ClearanceDescription> clearances;  ///< joints with play
  bool lock_massless = false;          ///< joints that move nothing with inertia are held where they start, not refused
  bool starts_in_equilibrium = false;  ///< at rest, where loads, gravity and servos at t = 0 hold it
  SourceLocation equilibrium_location = {};      ///< of the <initial> that says so
  std::vector<ParameterDescription> parameters;  ///< in the order of the file
};

/// Suffixes of the released coordinates of a joint in their order: {""} for one coordinate, {} for none,
/// planar /x /y /rz (axis-normal plane), floating /x /y /z /rx /ry /rz, spherical /rx /ry /rz, universal /1 /2 (the two
/// angles), cylindrical /1 /2 (travel, angle), slides {""} if they release no rotation, else /s (arc length) and /rx
/// /ry /rz, /1 or /1 /2 of their rotation (/1: also the angle on which the arc length depends). Rotations /rx /ry /rz
/// are the components of the rotation vector.
const std::vector<std::string>& coordinate_suffixes(const JointDescription& joint);

}  // namespace flexarm::scene
