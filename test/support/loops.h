#pragma once
/// Adds joints that close loops to scenes.

#include <algorithm>

#include "support/scene_builder.h"

namespace flexarm::test {

/// Adds a loop joint that holds `point` of the child (undeformed link frame) at its initial place. `axis` is in the
/// parent's frame.
inline scene::JointDescription& close_loop(SceneBuilder& builder, const std::string& name, scene::JointKind kind,
                                           const std::string& parent, const std::string& child,
                                           const Vector3& point = Vector3::Zero(),
                                           const Vector3& axis = Vector3::UnitZ()) {
  const Simulation simulation(builder.scene);
  const auto pose = [&](const std::string& link) {
    const std::vector<std::string>& names = simulation.link_names();
    return simulation.link_pose(std::find(names.begin(), names.end(), link) - names.begin());
  };
  scene::JointDescription joint;
  joint.name = name;
  joint.kind = kind;
  joint.parent = parent;
  joint.child = child;
  joint.child_origin.position = point;
  joint.origin.position = (pose(parent).inverse() * pose(child) * Pose{point, Quaternion::Identity()}).position;
  joint.axis = axis;
  builder.scene.loop_joints.push_back(joint);
  return builder.scene.loop_joints.back();
}

}  // namespace flexarm::test
