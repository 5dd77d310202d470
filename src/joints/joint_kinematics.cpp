#include "joints/joint_kinematics.h"

#include <cassert>
#include <cstddef>

namespace flexarm {
NodePose slave_pose(const Model& model, int j, const std::vector<NodePose>& nodes, const Released& released) {
  assert(j >= 0 && static_cast<std::size_t>(j) < model.joints.size_with_held() && nodes.size() == model.nodes.size());
  const JointMap& joint = model.joints[j];
  if (joint.kind == JointMapKind::Slide)
    return slide_pose(model.slide_lines[joint.line], nodes, released.displacement[0]);
  return slave_pose(joint, master_pose(joint, nodes), released);
}

SlaveVelocity slave_velocity(const Model& model, int j, const std::vector<NodePose>& nodes, const Released& released,
                             const std::vector<Vector6>& velocities) {
  assert(j >= 0 && static_cast<std::size_t>(j) < model.joints.size_with_held());
  assert(nodes.size() == model.nodes.size() && velocities.size() == nodes.size());
  const JointMap& joint = model.joints[j];
  SlaveVelocity out;
  out.carried.setZero();
  if (joint.kind == JointMapKind::Slide) {
    const SlideLine& line = model.slide_lines[joint.line];
    thread_local SlideMaps maps;
    slide_variational_maps(line, nodes, released.displacement[0], Vector6::Zero(), maps, false);
    for (int k = 0; k < maps.count; ++k) out.carried += maps.right[k] * velocities[line.nodes[maps.first + k]];
    out.columns = maps.released_right;
    return out;
  }
  const JointPose pose = joint_pose(joint, nodes, released);
  FoldMaps maps;
  variational_maps(joint, pose, Vector6::Zero(), maps);
  out.columns = maps.right;
  if (joint.master >= 0)
    out.carried =
        slave_velocity(joint, pose, velocities[joint.master], ReleasedVector::Zero(released_count(joint.kind)));
  return out;
}

ReleasedVector released_rates(const Model& model, int j, const std::vector<NodePose>& nodes, const Released& released,
                              const std::vector<Vector6>& velocities) {
  assert(j >= 0 && static_cast<std::size_t>(j) < model.joints.size_with_held() && model.joints[j].slave >= 0);
  assert(nodes.size() == model.nodes.size() && velocities.size() == nodes.size());
  const JointMap& joint = model.joints[j];
  if (joint.kind != JointMapKind::Slide)
    return released_rates(joint, joint_pose(joint, nodes, released),
                          joint.master < 0 ? Vector6(Vector6::Zero()) : velocities[joint.master],
                          velocities[joint.slave]);
  const SlaveVelocity slave = slave_velocity(model, j, nodes, released, velocities);
  return slave.columns.transpose() * (velocities[joint.slave] - slave.carried) / slave.columns.col(0).squaredNorm();
}

StateRates::StateRates(const Model& model) {
  for (const JointMap& joint : model.joints)
    if (joint.kind == JointMapKind::Slide) poses_.resize(model.nodes.size());
  velocities_.resize(poses_.size());
}

double StateRates::operator()(const Model& model, const State& state, int c) {
  const Coordinate& coordinate = model.coordinates[c];
  const JointMap& joint = model.joints[coordinate.joint];
  const Released& released = state.released[coordinate.joint];
  if (joint.kind != JointMapKind::Slide) {
    const bool is_on_ground = joint.master < 0;
    const NodePose master = is_on_ground ? NodePose() : node_pose(state.nodes[joint.master]);
    const Vector6 carrying = is_on_ground ? Vector6(Vector6::Zero()) : spatial_velocity(state.nodes[joint.master]);
    return released_rates(joint, {master, node_pose(state.nodes[joint.slave]), released}, carrying,
                          spatial_velocity(state.nodes[joint.slave]))[coordinate.component];
  }
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    poses_[i] = node_pose(state.nodes[i]);
    velocities_[i] = spatial_velocity(state.nodes[i]);
  }
  return released_rates(model, coordinate.joint, poses_, released, velocities_)[coordinate.component];
}

}  // namespace flexarm
