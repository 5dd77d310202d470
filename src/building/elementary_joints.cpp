#include "building/elementary_joints.h"

#include <cmath>
#include <utility>

namespace flexarm {
namespace {

/// Two directions that span the plane normal to `axis`. If the axis is z, they are the frame's own x and y.
std::pair<Vector3, Vector3> plane_axes(const Vector3& axis) {
  const Vector3 guess = std::abs(axis.x()) < 0.9 ? Vector3::UnitX() : Vector3::UnitY();
  const Vector3 first = (guess - guess.dot(axis) * axis).normalized();
  return {first, axis.cross(first)};
}

/// `offset`: from the joint's origin to the moved frame, at coordinate 0.
JointMap scalar_map(const Vector3& translation, const Vector3& rotation, const Vector3& offset = Vector3::Zero()) {
  JointMap map;
  map.origin.position = offset;
  map.kind = JointMapKind::Scalar;
  map.translation = translation;
  map.rotation = rotation;
  return map;
}

JointMap map_of_kind(JointMapKind kind) {
  JointMap map;
  map.kind = kind;
  return map;
}

/// The travel of a joint whose travel depends on its angle.
struct DependentTravel {
  double ratio;  // travel per angle, or per travel of the profile
  Vector3 direction, offset;
};
DependentTravel dependent_travel(const scene::JointDescription& joint) {
  const Vector3 axis = joint.axis.normalized();
  switch (joint.kind) {
    case scene::JointKind::RackAndPinion:  // the pinion's centre is off the pitch line
      return {joint.ratio, joint.direction, joint.ratio * joint.direction.cross(axis)};
    case scene::JointKind::Worm:
      return {joint.ratio, joint.direction, joint.offset * joint.direction.cross(axis)};
    case scene::JointKind::Cam:
      return {1, joint.direction, Vector3::Zero()};
    default:
      return {joint.ratio, axis, Vector3::Zero()};
  }
}

}  // namespace

std::vector<JointMap> elementary_joints(const scene::JointDescription& joint) {
  using scene::JointKind;
  const Vector3 zero = Vector3::Zero(), a = joint.axis.normalized(), a2 = joint.axis2.normalized();
  switch (joint.kind) {
    case JointKind::Revolute:
    case JointKind::Continuous:
      return {scalar_map(zero, a)};
    case JointKind::Prismatic:
      return {scalar_map(a, zero)};
    case JointKind::Planar: {
      const auto [x, y] = plane_axes(a);
      return {scalar_map(x, zero), scalar_map(y, zero), scalar_map(zero, a)};
    }
    case JointKind::Universal:
      return {scalar_map(zero, a), scalar_map(zero, a2)};
    case JointKind::Cylindrical:
      return {scalar_map(a, zero), scalar_map(zero, a)};
    case JointKind::PinSlot:
      return {scalar_map(a, zero), scalar_map(zero, a2)};
    case JointKind::Screw:
    case JointKind::RackAndPinion:
    case JointKind::Worm:
    case JointKind::Cam: {
      const DependentTravel travel = dependent_travel(joint);
      JointMap map = scalar_map(travel.ratio * travel.direction, a, travel.offset);
      map.profile = joint.profile;
      if (joint.slide) map.translation.setZero();  // the slide makes the translation
      return {map};
    }
    case JointKind::Spherical:
      return {map_of_kind(JointMapKind::Spherical)};
    case JointKind::Floating:
      return {map_of_kind(JointMapKind::Free)};
    case JointKind::Fixed:
    case JointKind::Slide:  // its rotation is a joint of another kind
      break;
  }
  return {};
}

std::vector<std::string> coordinate_names(const scene::JointDescription& joint) {
  std::vector<std::string> names;
  for (const std::string& suffix : scene::coordinate_suffixes(joint)) names.push_back(joint.name + suffix);
  return names;
}

}  // namespace flexarm
