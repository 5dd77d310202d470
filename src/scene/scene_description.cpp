#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

namespace {

const std::vector<std::string>& slide_suffixes(JointKind rotation) {
  static const std::vector<std::string> fixed = {""}, revolute = {"/s", "/1"}, universal = {"/s", "/1", "/2"},
                                        spherical = {"/s", "/rx", "/ry", "/rz"};
  if (rotation == JointKind::Fixed) return fixed;
  if (rotation == JointKind::Universal) return universal;
  return rotation == JointKind::Spherical ? spherical : revolute;
}

}  // namespace

const std::vector<std::string>& coordinate_suffixes(const JointDescription& joint) {
  static const std::vector<std::string> none, one = {""}, planar = {"/x", "/y", "/rz"},
                                              free = {"/x", "/y", "/z", "/rx", "/ry", "/rz"},
                                              spherical = {"/rx", "/ry", "/rz"}, two = {"/1", "/2"};
  switch (joint.kind) {
    case JointKind::Fixed:
      return none;
    case JointKind::Revolute:
    case JointKind::Continuous:
    case JointKind::Prismatic:
    case JointKind::Screw:
    case JointKind::RackAndPinion:
    case JointKind::Worm:
    case JointKind::Cam:
      return one;
    case JointKind::Planar:
      return planar;
    case JointKind::Floating:
      return free;
    case JointKind::Spherical:
      return spherical;
    case JointKind::Slide:
      return slide_suffixes(joint.slide->rotation);
    case JointKind::Universal:
    case JointKind::Cylindrical:
      return two;
  }
  return none;
}

}  // namespace flexarm::scene
