#pragma once
/// The joints of a scene as plain data: kinds, limits, friction, slides and play.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexarm/math/cam_profile.h"
#include "flexarm/math/pose.h"
#include "flexarm/scene/contact_description.h"
#include "flexarm/scene/source_location.h"

namespace flexarm::scene {

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
  // Kinds with one coordinate, the angle about `axis`, and a travel that depends on this angle:
  Screw,
  RackAndPinion,
  Worm,
  Cam,
  Slide,  ///< along the parent's flexible centreline. Coordinates: arc length, then those of SlideDescription::rotation
  PinSlot  // saved states know kinds by their numbers, so new ones come last
};

/// Whether it is a screw, rack and pinion, worm or cam.
constexpr bool has_dependent_travel(JointKind kind) {
  return kind == JointKind::Screw || kind == JointKind::RackAndPinion || kind == JointKind::Worm ||
         kind == JointKind::Cam;
}

struct JointLimits {
  double lower, upper;                     ///< position [rad or m]
  double velocity = 0;                     ///< stored but not enforced
  std::optional<double> restitution = {};  ///< coefficient of the stops, from 0 to 1; empty: 0.3
  /// That an undamped hit lasts [s]; empty: SceneDescription::contact_time.
  std::optional<double> contact_time = {};
  std::optional<double> stiffness = {};  ///< of the stops [N/m or N m/rad]; instead of a contact time
};

/// The coordinate follows another one: multiplier * (coordinate of `joint`) + offset.
struct Mimic {
  std::string joint;
  double multiplier = 1, offset = 0;
};

/// The part of a <joint> of kind Slide that says how it slides.
struct SlideDescription {
  enum class End {
    Stop,   ///< a unilateral stop with restitution
    Error,  ///< the step fails
    Free    ///< the slider leaves the line and moves on freely
  };
  double start = 0;  ///< initial arc length [m]
  /// The rotation that the joint allows: Fixed, Revolute, Universal or Spherical. Or a kind with dependent travel: then
  /// the arc length is `start` + travel.
  JointKind rotation = JointKind::Spherical;
  End on_end = End::Stop;                  ///< what happens at the ends of the line
  std::string scheme = "sm_em";            ///< time integration of the sliding contact (docs/schemes.md)
  bool smooth = true;                      ///< make the line's tangent continuous across element borders
  Vector3 offset = Vector3::Zero();        ///< rigid offset from the line to the joint, in the joint frame [m]
  std::optional<double> restitution = {};  ///< coefficient of the stops, from 0 to 1; empty: 0.3
  SourceLocation location = {};
};

/// Dry friction of a joint's coordinates: how it depends on the rate, and a part that depends on the joint's force,
/// which acts in addition to the constant friction effort of <dynamics friction>.
struct FrictionDescription {
  enum class Law {
    Smooth,  ///< F tanh(rate / v)
    Coulomb  ///< set-valued: sticks exactly
  };
  Law law = Law::Smooth;
  double coefficient = 0;  ///< relative to the force normal to the travel, or across the axis [-]
  double radius = 0;       ///< of the bearing: lever arm of the friction force of rotations [m]
  /// Friction at rest, relative to that of fast sliding. In between it falls as exp(-(rate / stribeck_speed)^2).
  double static_ratio = 1;
  double stribeck_speed = 0.01;  ///< [rad/s or m/s]
};

struct JointDescription {
  std::string name;
  JointKind kind = JointKind::Fixed;
  std::string parent, child;        ///< link names
  Pose origin;                      ///< joint frame in the parent link frame
  Vector3 axis = Vector3::UnitX();  ///< unit vector in the joint frame (planar: the normal)
  /// Second axis, unit, in the joint frame: of a universal joint after the rotation by the first angle; of a pin in
  /// a slot the pin's axis.
  Vector3 axis2 = Vector3::UnitY();
  // Joints with dependent travel
  double ratio = 0;   ///< travel per angle: pitch, radius of the pinion, ratio of the worm [m/rad]
  double offset = 0;  ///< worm: distance of the moved axis from the joint's origin, along direction x axis [m]
  Vector3 direction = Vector3::UnitX();       ///< unit vector of the travel in the joint frame; for a screw its axis
  std::shared_ptr<const CamProfile> profile;  ///< cam: travel as a function of the angle
  std::optional<SlideDescription> slide;      ///< for JointKind::Slide
  std::optional<JointLimits> limits;          ///< only for limited positions (revolute, prismatic, dependent travel)
  double effort_limit = 0;                    ///< bound of commanded efforts, for any kind [N or N m]; 0: unlimited
  double damping = 0;                         ///< for each coordinate of the joint [N s/m or N m s/rad]
  double friction = 0;                        ///< constant Coulomb friction effort for each coordinate [N or N m]
  FrictionDescription friction_law;
  std::optional<Mimic> mimic;
  Pose child_origin;  ///< only loop joints: joint frame in the child link frame
  SourceLocation location;
  bool is_hidden = false;  ///< its coordinates are computed, but users neither see nor name them
};

/// A joint with play. Within the play its child moves freely; contacts at the ends of the play replace the joint's
/// constraint. A joint of the tree with play becomes a floating joint with contacts, a loop joint just the contacts.
struct ClearanceDescription {
  JointDescription joint;  ///< the joint without play: revolute, continuous, prismatic or spherical
  bool closes_loop = false;
  double radius = 0;                        ///< the play: gap between the hole and its pin, ball or block, per side [m]
  std::optional<double> length = {};        ///< of the pin or block along the axis [m]; empty: see docs/scene/play.md
  std::optional<double> width = {};         ///< of the block's square section [m]; empty: `length`
  double journal = 0;                       ///< radius of the pin or ball [m]; required with friction
  std::optional<double> stiffness = {};     ///< of a contact point [N/m]; empty: from moved masses and contact time
  std::optional<double> contact_time = {};  ///< as JointLimits::contact_time
  RestitutionDescription restitution = {};
  double friction = 0;           ///< Coulomb coefficient
  SourceLocation location = {};  ///< of the element <clearance>
};

/// Suffixes of the names of a joint's coordinates, in order:
/// - one coordinate: {""}; no coordinate: {};
/// - planar: /x /y /rz (in the plane normal to the axis);
/// - floating: /x /y /z /rx /ry /rz; spherical: /rx /ry /rz;
/// - universal: /1 /2 (the two angles); cylindrical, pin_slot: /1 /2 (travel, angle);
/// - slides: {""} without rotation; else /s (arc length) and the suffixes of their rotation, /rx /ry /rz, /1 or /1 /2.
///   With dependent travel, /1 also determines the arc length.
///
/// Rotations /rx /ry /rz are the components of the rotation vector.
const std::vector<std::string>& coordinate_suffixes(const JointDescription& joint);

}  // namespace flexarm::scene
