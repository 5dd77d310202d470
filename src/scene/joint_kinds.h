#pragma once
/// What is known of each kind of joints. A new kind is a row of this table, and its chain of elementary joints in
/// building/elementary_joints.cpp.

#include <string>
#include <vector>

#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

struct JointKindTraits {
  JointKind kind;
  const char* name;     ///< as in URDF or flexarm's extension of it: "revolute", "rack_and_pinion"
  const char* type;     ///< the <joint type> that stands for it; null: none
  const char* release;  ///< the <release kind> that stands for it; null: none
  int axes;             ///< that a scene may give it: none, <axis>, or <axis> and <axis2>
  /// Of its coordinates. Those of slides follow from their rotation.
  std::vector<std::string> suffixes;
  bool may_have_stops;    ///< <limit> gives the range of its coordinate
  bool may_have_play;     ///< <clearance> may replace it
  bool has_normal_force;  ///< on which friction may depend
  bool keeps_place;       ///< its child stays at its origin
};

/// A row for each value of JointKind.
const std::vector<JointKindTraits>& joint_kinds();
const JointKindTraits& traits_of(JointKind kind);

struct JointKindName {
  const char* name;
  JointKind kind;
};
/// The kinds that a <joint type>, or a <release kind>, can name.
const std::vector<JointKindName>& joint_types();
const std::vector<JointKindName>& joint_releases();

}  // namespace flexarm::scene
