#include "scene/joint_kinds.h"

#include <algorithm>

namespace flexarm::scene {
namespace {

std::vector<JointKindName> named_kinds(const char* JointKindTraits::*name) {
  std::vector<JointKindName> out;
  for (const JointKindTraits& traits : joint_kinds())
    if (traits.*name) out.push_back({traits.*name, traits.kind});
  return out;
}

const std::vector<std::string>& slide_suffixes(JointKind rotation) {
  static const std::vector<std::string> fixed = {""}, revolute = {"/s", "/1"}, universal = {"/s", "/1", "/2"},
                                        spherical = {"/s", "/rx", "/ry", "/rz"};
  if (rotation == JointKind::Fixed) return fixed;
  if (rotation == JointKind::Universal) return universal;
  return rotation == JointKind::Spherical ? spherical : revolute;
}

}  // namespace

const std::vector<JointKindTraits>& joint_kinds() {
  using Suffixes = std::vector<std::string>;
  static const Suffixes none, one = {""}, two = {"/1", "/2"}, plane = {"/x", "/y", "/rz"},
                              rotation = {"/rx", "/ry", "/rz"}, all = {"/x", "/y", "/z", "/rx", "/ry", "/rz"};
  using Kind = JointKind;
  // kind; name, type, release; axes, suffixes; may_have_stops, may_have_play, has_normal_force, keeps_place
  static const std::vector<JointKindTraits> kinds = {
      {Kind::Fixed, "fixed", "fixed", nullptr, 0, none, false, false, false, true},
      {Kind::Revolute, "revolute", "revolute", nullptr, 1, one, true, true, true, true},
      {Kind::Continuous, "continuous", "continuous", nullptr, 1, one, false, true, true, true},
      {Kind::Prismatic, "prismatic", "prismatic", nullptr, 1, one, true, true, true, false},
      {Kind::Planar, "planar", "planar", "planar", 1, plane, false, false, false, false},
      {Kind::Floating, "floating", "floating", "free", 0, all, false, false, false, false},
      {Kind::Spherical, "spherical", "spherical", "spherical", 0, rotation, false, true, false, true},
      {Kind::Universal, "universal", nullptr, "universal", 2, two, false, false, true, true},
      {Kind::Cylindrical, "cylindrical", nullptr, "cylindrical", 1, two, false, false, true, false},
      {Kind::PinSlot, "pin_slot", nullptr, "pin_slot", 2, two, false, false, true, false},
      {Kind::Screw, "screw", nullptr, nullptr, 1, one, true, false, true, false},
      {Kind::RackAndPinion, "rack_and_pinion", nullptr, nullptr, 1, one, true, false, true, false},
      {Kind::Worm, "worm", nullptr, nullptr, 1, one, true, false, true, false},
      {Kind::Cam, "cam", nullptr, nullptr, 1, one, true, false, true, false},
      {Kind::Slide, "slide", nullptr, nullptr, 1, none, false, false, true, false}};
  return kinds;
}

const JointKindTraits& traits_of(JointKind kind) {
  return *std::find_if(joint_kinds().begin(), joint_kinds().end(),
                       [&](const JointKindTraits& traits) { return traits.kind == kind; });
}

const std::vector<JointKindName>& joint_types() {
  static const std::vector<JointKindName> types = named_kinds(&JointKindTraits::type);
  return types;
}

const std::vector<JointKindName>& joint_releases() {
  static const std::vector<JointKindName> releases = named_kinds(&JointKindTraits::release);
  return releases;
}

const std::vector<std::string>& coordinate_suffixes(const JointDescription& joint) {
  return joint.kind == JointKind::Slide ? slide_suffixes(joint.slide->rotation) : traits_of(joint.kind).suffixes;
}

}  // namespace flexarm::scene
