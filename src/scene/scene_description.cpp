#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

const std::vector<std::string>& coordinate_suffixes(JointKind kind) {
  static const std::vector<std::string> none, one = {""}, planar = {"/x", "/y", "/rz"},
                                              free = {"/x", "/y", "/z", "/rx", "/ry", "/rz"},
                                              spherical = {"/rx", "/ry", "/rz"}, two = {"/1", "/2"};
  switch (kind) {
    case JointKind::Fixed:
      return none;
    case JointKind::Revolute:
    case JointKind::Continuous:
    case JointKind::Prismatic:
      return one;
    case JointKind::Planar:
      return planar;
    case JointKind::Floating:
      return free;
    case JointKind::Spherical:
      return spherical;
    case JointKind::Universal:
    case JointKind::Cylindrical:
      return two;
  }
  return none;
}

}  // namespace flexarm::scene
