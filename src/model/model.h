#pragma once
/// The constant data of a mechanism: nodes, elements, joints, loads. It does not change after building.

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexarm/math/time_function.h"
#include "model/actuator.h"
#include "model/beam_element.h"
#include "model/force_element.h"
#include "model/joint.h"
#include "model/loop_closure.h"
#include "model/nodal_load.h"
#include "model/prestrain.h"
#include "model/slide_line.h"

namespace flexarm {

/// Mass and rotary inertia lumped at a node, in the node's frame. The node is at the centre of mass.
struct NodalInertia {
  double mass = 0;                           ///< [kg]
  Matrix3 rotary = Matrix3::Zero();          ///< of rigid bodies [kg m^2]
  Matrix3 beam_rotary = Matrix3::Zero();     ///< of the beams, int I^i ds J; for schemes that lump it [kg m^2]
  Matrix3 rotary_damping = Matrix3::Zero();  ///< mass-proportional damping of the beams' rotation [kg m^2/s]
  double total_mass = 0;                     ///< including the beams' share int I^i mass ds; for weight, momentum [kg]
  bool empty() const { return mass == 0 && rotary.isZero(0) && beam_rotary.isZero(0) && rotary_damping.isZero(0); }
};

/// Unilateral stops of a scalar coordinate, whose stiffness grows with penetration (joints/joint_stop.h).
struct LimitStop {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double lower, upper;
  double inertia = 0;                                     ///< that the coordinate moves initially [kg or kg m^2]
  double give_below = kInfinity, give_above = kInfinity;  ///< largest possible penetrations, > 0 [m or rad]
  /// Damping over the critical damping of the oscillator that stop and coordinate form. The default gives a restitution
  /// of 0.3 (joints/stop_restitution.h).
  double damping_ratio = 0.497239;
  double contact_time = 0;  ///< that an undamped hit lasts [s]; 0: the stiffness is given
  double stiffness = 0;     ///< for small penetrations [N/m or N m/rad]
  double damping = 0;       ///< the same [N s/m or N m s/rad]

  /// Sets the inertia, and what follows from it.
  void carry(double moved_inertia);
};

/// The law by which a coordinate follows another one, u: offset + multiplier f(u).
struct MimicLaw {
  double multiplier = 1, offset = 0;
  std::shared_ptr<const CamProfile> profile;  ///< f; null: f(u) = u

  double value(double u) const { return offset + multiplier * (profile ? profile->value(u) : u); }
  double derivative(double u) const { return multiplier * (profile ? profile->derivative(u) : 1.0); }
  double second_derivative(double u) const { return profile ? multiplier * profile->second_derivative(u) : 0.0; }
  double secant(double from, double to) const { return multiplier * (profile ? profile->secant(from, to) : 1.0); }
  /// Derivative of secant() with respect to `to`.
  double secant_derivative(double from, double to) const {
    return profile ? multiplier * profile->secant_derivative(from, to) : 0.0;
  }
};

/// One scalar released coordinate of a joint, under the name that users know.
struct Coordinate {
  std::string name;
  int joint = -1;         ///< index into Model::joints
  int component = 0;      ///< index among the joint's released coordinates
  bool is_angle = false;  ///< component of a rotation vector of a Spherical or Free joint
  double damping = 0, friction = 0;
  bool sticks = false;              ///< set-valued Coulomb law; else smooth
  double friction_coefficient = 0;  ///< friction per normal force in the joint; times a radius for an angle
  double static_ratio = 1;          ///< friction at rest, relative to that of fast sliding; see FrictionDescription
  double stribeck_speed = 1;        ///< [rad/s or m/s]
  double effort_limit = 0;          ///< 0: none
  std::optional<LimitStop> limit;
  int motion = -1;    ///< history index of a prescribed position; -1: free
  int effort = -1;    ///< history index of the scene's effort; -1: none
  int mimicked = -1;  ///< coordinate that this one follows; -1: none
  MimicLaw mimic;
  int actuator = -1;        ///< index into Model::actuators; -1: none
  bool is_coupled = false;  ///< it mimics the next coordinate, which belongs to the same joint of the scene
};

/// A frame fixed to a node.
struct Attachment {
  int node = -1;
  Pose offset;
};

/// The elements of a flexible link in their order along the line, for output.
struct BeamLink {
  int order = 2;                     ///< the elements belong to the group with order + 1 nodes
  std::vector<int> elements;         ///< indices into that group
  std::vector<double> element_ends;  ///< arc length at the end of each [m]
  std::vector<ElementPart> parts;    ///< the part of the scene's element that each is
  bool refines = false;              ///< elements are halved while they are strongly bent
  Attachment tip;
  Vector3 centroid =
      Vector3::Zero();  ///< mass centroid in the section; nodes are there, so the reference line is at -centroid
  double length = 0, mass = 0, radius = 0;
};

/// A place on a beam's line: the index of the element along the line, and the shape parameter xi in [-1, 1] in it.
struct ElementPlace {
  int element = 0;
  double xi = 0;
};
/// Returns the place at an arc length from 0 to the beam's length. A border between elements belongs to the first one.
ElementPlace element_at(const BeamLink& beam, double arc_length);

struct LinkFrame {
  std::string name;
  Attachment frame;  ///< of the link's origin
  std::optional<BeamLink> beam;
};

/// A point of a link for output: on a node, or inside an element of the link's beam at shape parameter xi in [-1, 1].
struct ProbePoint {
  int link = -1;
  Attachment attachment;  ///< node < 0: inside an element
  int element = -1;
  double xi = 0;
  Pose offset;  ///< inside an element: in the interpolated section frame
};

/// A joint or loop closure whose reaction on one of its links is kept for output. A joint acts on the link of its
/// slave, a closure on that of its child, unless `is_reversed`.
struct ReactionPlace {
  int joint = -1;            ///< elementary joint; -1: it is a closure
  int closure = -1;          ///< loop closure, if `joint` is -1
  bool is_reversed = false;  ///< the reaction is that on the other link
  Attachment point;          ///< of the link; moments are about the origin of this frame

  bool operator==(const ReactionPlace& other) const {
    return joint == other.joint && closure == other.closure && is_reversed == other.is_reversed &&
           point.node == other.point.node && point.offset.position == other.point.offset.position;
  }
};

/// A joint with a constant prescribed motion. The rigid links that it carries are parts of its master's body, or of the
/// world. A step only computes its effort, when the step is accepted. In its JointMap the slave is the master node
/// itself. This is possible since only the axes and arms of that map are used, and they do not depend on the slave's
/// position.
struct HeldJoint {
  int coordinate = -1;
  // Data of the rigid links that it carries, directly or through fixed and other held joints, in the master's frame:
  double mass = 0;                    ///< [kg]
  Vector3 centre = Vector3::Zero();   ///< centre of mass [m]
  Matrix3 inertia = Matrix3::Zero();  ///< about the centre of mass [kg m^2]
  std::vector<bool> links;            ///< per link of the model: whether the joint carries it
  std::vector<int> outboard;          ///< joints whose masters are on these links
};

/// Two links, or a link and a ground, that may touch, and the force elements of their contact.
struct TouchingPair {
  struct Element {
    std::size_t index;   ///< into Model::force_elements
    std::size_t memory;  ///< index at which its own part of State::force_memory begins
  };
  std::string first, second;  ///< names of links or grounds, in the order of ForceElement::links()
  std::vector<Element> elements;
};

/// The place of a sensor, and what it measures there.
struct SensorPlace {
  /// A pair of bodies whose contact forces the sensor measures.
  struct Touched {
    std::size_t pair;  ///< index into Model::touching_pairs
    bool is_first;     ///< it measures the forces on the first body; else those on the second
  };
  ProbePoint point;
  int reaction = -1;  ///< index into Model::reactions; -1: it does not measure a reaction
  std::vector<Touched> touched = {};
  std::size_t force_element = 0;  ///< of a sensor of a tendon: index into Model::force_elements
};

struct Model {
  // ---- mechanics
  std::vector<NodePose> nodes;         ///< initial poses (released coordinates at their initial values)
  std::vector<int> node_parents;       ///< per node: the next node towards the root, which carries it along; -1: world
  std::vector<NodalInertia> inertias;  ///< per node
  BeamGroups beams;
  std::vector<HalvedElement> halved;  ///< in ascending order
  int stiffness_point_count = 0, mass_point_count = 0;
  int maxwell_branches = 0;  ///< the largest number of Maxwell branches of a beam
  JointList joints;
  std::vector<HeldJoint> held;
  std::vector<SlideLine> slide_lines;
  std::vector<LoopClosure> closures;       ///< loop closures with multipliers
  ForceElementList force_elements;         ///< springs, contacts and other forces between points
  std::vector<Released> initial_released;  ///< per joint, held ones included
  std::vector<Vector6> initial_velocity;   ///< per node {v, w}, spatial
  std::vector<Coordinate> coordinates;
  std::vector<int> first_coordinate;  ///< per joint, held ones included; its coordinates are consecutive
  std::vector<Actuator> actuators;
  std::vector<NodalLoad> loads;
  std::vector<Prestrain> prestrains;
  std::vector<TimeFunction> histories;
  Vector3 gravity = Vector3::Zero();
  /// Only free joints connect the mechanism to the world, and nothing depends on its position: the origin of positions
  /// may move along with it (model/carried_origin.h).
  bool floats = false;
  Vector3 initial_origin = Vector3::Zero();  ///< State::origin at the start [m]
  double length_scale = 1;  ///< extent of the mechanism; scales displacements in the convergence test [m]

  // ---- output
  Vector3 origin = Vector3::Zero();  ///< of joints on the world; with State::origin added, of positions [m]
  std::vector<LinkFrame> links;      ///< in the scene's order
  std::vector<ProbePoint> probes;
  std::vector<ReactionPlace> reactions;  ///< those that sensors or other output need
  std::vector<SensorPlace> sensors;
  std::vector<TouchingPair> touching_pairs;  ///< the contacts among force_elements, by pairs of bodies
};

/// Returns the mass of everything that moves [kg].
double mass_of(const Model& model);

/// Returns the inertia of the motor's rotor if it turns with the coordinate (rigid gear), else 0 [kg m^2 or kg].
inline double armature(const Model& model, const Coordinate& coordinate) {
  if (coordinate.actuator < 0) return 0;
  const Drive& drive = model.actuators[coordinate.actuator].drive;
  return drive.gear ? 0 : drive.inertia;
}

/// Whether the coordinate is that of a HeldJoint.
inline bool is_held(const Model& model, const Coordinate& coordinate) {
  return model.joints.is_held(coordinate.joint);
}

/// Whether joints have limits.
inline bool has_stops(const Model& model) {
  return std::any_of(model.coordinates.begin(), model.coordinates.end(),
                     [](const Coordinate& coordinate) { return coordinate.limit.has_value(); });
}

/// Whether the coordinate's unit is rad: it is a component of a free rotation, or a scalar that causes a rotation.
inline bool is_rotation(const Model& model, const Coordinate& coordinate) {
  return coordinate.is_angle || !model.joints[coordinate.joint].rotation.isZero(0);
}

}  // namespace flexarm
