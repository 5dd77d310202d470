#include "scene/joint_kind_names.h"

namespace flexarm::scene {

const char* name_of(JointKind kind) {
  switch (kind) {
    case JointKind::Fixed:
      return "fixed";
    case JointKind::Revolute:
      return "revolute";
    case JointKind::Continuous:
      return "continuous";
    case JointKind::Prismatic:
      return "prismatic";
    case JointKind::Planar:
      return "planar";
    case JointKind::Floating:
      return "floating";
    case JointKind::Spherical:
      return "spherical";
    case JointKind::Universal:
      return "universal";
    case JointKind::Screw:
      return "screw";
    case JointKind::RackAndPinion:
      return "rack_and_pinion";
    case JointKind::Worm:
      return "worm";
    case JointKind::Cam:
      return "cam";
    case JointKind::Slide:
      return "slide";
    case JointKind::Cylindrical:
      return "cylindrical";
  }
  return "";
}

}  // namespace flexarm::scene
