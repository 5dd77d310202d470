#pragma once
/// The mechanism as numbers: nodes, elements, joints, loads and their numbering. Immutable after building.

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

/// Mass and rotary inertia lumped at a node whose origin is their centre of mass, in the node's frame.
struct NodalInertia {
  double mass = 0;                           ///< [kg]
  Matrix3 rotary = Matrix3::Zero();          ///< of rigid bodies [kg m^2]
  Matrix3 beam_rotary = Matrix3::Zero();     ///< of the beams, int I^i ds J; used where a scheme lumps it [kg m^2]
  Matrix3 rotary_damping = Matrix3::Zero();  ///< mass-proportional damping of the beams' rotation [kg m^2/s]
  double total_mass = 0;                     ///< with the beams' share int I^i mass ds: weight and momentum [kg]
  bool empty() const { return mass == 0 && rotary.isZero(0) && beam_rotary.isZero(0) && rotary_damping.isZero(0); }
};

/// Of a stop's damper, over the critical one of the oscillator that the stop makes of its coordinate: where forces are
/// means of steps, and where they are those at the end. These give 30 % of the speed back (joints/stop_restitution.h).
struct StopDamping {
  double of_means = 0.497239, at_end = 0.580020;
};

/// Unilateral stops of a scalar coordinate, which harden (joints/joint_stop.h).
struct LimitStop {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double lower, upper;
  double inertia = 0;                                     ///< what the coordinate moves, at the start [kg or kg m^2]
  double give_below = kInfinity, give_above = kInfinity;  ///< how far they give way at most, > 0
  StopDamping damping = {};
};

/// How a coordinate follows another one u: offset + multiplier f(u).
struct MimicLaw {
  double multiplier = 1, offset = 0;
  std::shared_ptr<const CamProfile> profile;  ///< f; null: f(u) = u

  double value(double u) const { return offset + multiplier * (profile ? profile->value(u) : u); }
  double derivative(double u) const { return multiplier * (profile ? profile->derivative(u) : 1.0); }
  double second_derivative(double u) const { return profile ? multiplier * profile->second_derivative(u) : 0.0; }
  double secant(double from, double to) const { return multiplier * (profile ? profile->secant(from, to) : 1.0); }
  /// Of the secant, with respect to `to`.
  double secant_derivative(double from, double to) const {
    return profile ? multiplier * profile->secant_derivative(from, to) : 0.0;
  }
};

/// One released scalar as users see it.
struct Coordinate {
  std::string name;
  int joint = -1;         ///< index into Model::joints
  int component = 0;      ///< row among the joint's released coordinates
  bool is_angle = false;  ///< component of a rotation vector of a Spherical or Free joint
  double damping = 0, friction = 0;
  bool sticks = false;              ///< set-valued Coulomb law; else smooth
  double friction_coefficient = 0;  ///< of the joint's normal force, times a radius where the coordinate is an angle
  double effort_limit = 0;          ///< 0: none
  std::optional<LimitStop> limit;
  int motion = -1;    ///< history index of a prescribed position; -1: free
  int effort = -1;    ///< history index of the scene's effort; -1: none
  int mimicked = -1;  ///< coordinate that this one follows; -1: none
  MimicLaw mimic;
  int actuator = -1;        ///< index into Model::actuators; -1: none
  bool is_coupled = false;  ///< it follows the coordinate right behind it, of the same joint
};

/// A frame fixed to a node.
struct Attachment {
  int node = -1;
  Pose offset;
};

/// Placement of a flexible link's mesh, for output: elements in order along the line.
struct BeamLink {
  int order = 2;                     ///< elements are in the group of order + 1 nodes
  std::vector<int> elements;         ///< indices into that group
  std::vector<double> element_ends;  ///< arc length at the end of each [m]
  Attachment tip;
  Vector3 centroid =
      Vector3::Zero();  ///< mass centroid in the section: nodes lie there, the reference line at -centroid
  double length = 0, mass = 0, radius = 0;
};

/// A place on a beam's line: an element, by its index along the line, and the shape parameter in [-1, 1] there.
struct ElementPlace {
  int element = 0;
  double xi = 0;
};
/// At an arc length from 0 to the beam's length; at an element's border in the one before.
ElementPlace element_at(const BeamLink& beam, double arc_length);

struct LinkFrame {
  std::string name;
  Attachment frame;  ///< of the link origin
  std::optional<BeamLink> beam;
};

/// A point of a link for output: on a node, or inside an element of the link's beam at shape parameter xi in [-1, 1].
struct ProbePoint {
  int link = -1;
  Attachment attachment;  ///< node < 0: inside an element
  int element = -1;
  double xi = 0;
  Pose offset;  ///< in the interpolated section frame
};

/// A joint of which is kept what it does to one of its links: one that acts upon its slave, or a closure that acts upon
/// its child.
struct ReactionPlace {
  int joint = -1;            ///< elementary
  int closure = -1;          ///< if there is no such
  bool is_reversed = false;  ///< the link is on the other side
  Attachment link;           ///< frame of the link: moments are about its origin

  bool operator==(const ReactionPlace& other) const {
    return joint == other.joint && closure == other.closure && is_reversed == other.is_reversed &&
           link.node == other.link.node && link.offset.position == other.link.offset.position;
  }
};

/// A joint whose motion is constant. The rigid links that it carries are parts of its master's body, or of the world:
/// it costs a step nothing but its effort, which is found when the step is accepted. Its map has the master as its
/// slave, too: which point of the master's frame is held where does not matter to what it says of axes and arms.
struct HeldJoint {
  int coordinate = -1;
  // Of the rigid links that it carries, those behind fixed and other held joints included, in the master's frame:
  double mass = 0;                    ///< [kg]
  Vector3 centre = Vector3::Zero();   ///< of mass [m]
  Matrix3 inertia = Matrix3::Zero();  ///< about the centre [kg m^2]
  std::vector<bool> links;            ///< per link: whether it is one of them
  std::vector<int> outboard;          ///< joints that hang on them
};

/// Two bodies that may touch, and the elements by which they do.
struct TouchingPair {
  struct Element {
    std::size_t index;   ///< into Model::force_elements
    std::size_t memory;  ///< where its own part of State::force_memory begins
  };
  std::string first, second;  ///< names of links or grounds, as ForceElement::links() has them
  std::vector<Element> elements;
};

/// Where a sensor sits.
struct SensorPlace {
  /// A pair whose contacts it measures: as they act on the first, or on the second.
  struct Touched {
    std::size_t pair;  ///< index into Model::touching_pairs
    bool is_first;
  };
  ProbePoint point;
  int reaction = -1;  ///< index into Model::reactions; -1: it does not measure one
  std::vector<Touched> touched = {};
};

struct Model {
  // ---- mechanics
  std::vector<NodePose> nodes;         ///< initial poses (released coordinates at their initial values)
  std::vector<int> node_parents;       ///< node that a node moves with when joints outboard of it move; -1: world
  std::vector<NodalInertia> inertias;  ///< per node
  BeamGroups beams;
  int stiffness_point_count = 0, mass_point_count = 0;
  JointList joints;
  std::vector<HeldJoint> held;
  std::vector<SlideLine> slide_lines;
  std::vector<LoopClosure> closures;       ///< loops that no joint closes by its slave
  ForceElementList force_elements;         ///< what acts between points
  std::vector<Released> initial_released;  ///< per joint, held ones included
  std::vector<Vector6> initial_velocity;   ///< per node {v, w}, spatial
  std::vector<Coordinate> coordinates;
  std::vector<int> first_coordinate;  ///< per joint, held ones included; its coordinates are consecutive
  std::vector<Actuator> actuators;
  std::vector<NodalLoad> loads;
  std::vector<Prestrain> prestrains;
  std::vector<TimeFunction> histories;
  Vector3 gravity = Vector3::Zero();
  /// All that hangs on the world does so by free joints, and nothing says where it is to be: the origin of positions
  /// may go with it (model/carried_origin.h).
  bool floats = false;
  Vector3 initial_origin = Vector3::Zero();  ///< State::origin at the start [m]
  double length_scale = 1;  ///< extent of the mechanism [m]: scales displacements in the convergence test

  // ---- output
  Vector3 origin = Vector3::Zero();  ///< of joints on the world and, but for State::origin, of positions [m]
  std::vector<LinkFrame> links;      ///< in the scene's order
  std::vector<ProbePoint> probes;
  std::vector<ReactionPlace> reactions;  ///< those that somebody asks for
  std::vector<SensorPlace> sensors;
  std::vector<TouchingPair> touching_pairs;  ///< of force_elements those that are contacts
};

/// Of all that moves [kg].
double mass_of(const Model& model);

/// Inertia of a rotor that turns with the coordinate [kg m^2 or kg].
inline double armature(const Model& model, const Coordinate& coordinate) {
  if (coordinate.actuator < 0) return 0;
  const Drive& drive = model.actuators[coordinate.actuator].drive;
  return drive.gear ? 0 : drive.inertia;
}

/// True for the coordinate of a HeldJoint.
inline bool is_held(const Model& model, const Coordinate& coordinate) {
  return model.joints.is_held(coordinate.joint);
}

/// True for coordinates that count in rad: free rotations, and scalars by which something turns.
inline bool is_rotation(const Model& model, const Coordinate& coordinate) {
  return coordinate.is_angle || !model.joints[coordinate.joint].rotation.isZero(0);
}

}  // namespace flexarm
