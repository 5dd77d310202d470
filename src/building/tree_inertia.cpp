#include "building/tree_inertia.h"

#include <cassert>

#include "math/so3.h"

namespace flexarm {

SpatialInertia moved(const SpatialInertia& inertia, const Vector3& way) {
  Matrix6 columns = Matrix6::Identity();
  columns.topRightCorner<3, 3>() = -so3::hat(way);
  return columns.transpose() * inertia * columns;
}

TreeInertia::TreeInertia(const std::vector<int>& parents, const Model& model)
    : parents_(parents),
      model_(model),
      joint_of_(model.nodes.size(), -1),
      columns_(model.joints.size()),
      outboard_(model.nodes.size()) {
  assert(parents.size() == model.nodes.size());
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointMap& joint = model.joints[j];
    // A joint that closes a loop at the end of a beam does not carry that beam.
    if (joint.kind == JointMapKind::Slide || parents[joint.slave] != joint.master) continue;
    joint_of_[joint.slave] = static_cast<int>(j);
    FoldMaps maps;
    variational_maps(joint, joint_pose(joint, model.nodes, model.initial_released[j]), Vector6::Zero(), maps);
    columns_[j] = maps.right;
  }
  for_each_inertia([&](int node, const SpatialInertia& inertia) { outboard_[node] = inertia; });
}

Vector6 TreeInertia::seen_at(Vector6 motion, int from, int to) const {
  motion.head<3>() += Vector3(motion.tail<3>()).cross(way(from, to));
  return motion;
}

SpatialInertia TreeInertia::own(int node) const {
  const NodalInertia& inertia = model_.inertias[node];
  const Matrix3& rotation = model_.nodes[node].rotation;
  SpatialInertia out = SpatialInertia::Zero();
  out.topLeftCorner<3, 3>().diagonal().setConstant(inertia.total_mass);
  out.bottomRightCorner<3, 3>() = rotation * (inertia.rotary + inertia.beam_rotary) * rotation.transpose();
  return out;
}

bool TreeInertia::hangs_on(int node, int inboard) const {
  while (node > inboard) node = parents_[node];
  return node == inboard;
}

Eigen::MatrixXd TreeInertia::mass_matrix(const std::vector<TreeMotion>& motions, Eigen::Index size) const {
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(size, size);
  for (const TreeMotion& outer : motions) {
    const Vector6 momentum = outboard_[outer.node] * outer.motion;
    for (const TreeMotion& inner : motions) {
      if (!hangs_on(outer.node, inner.node)) continue;
      const double entry = momentum.dot(seen_at(inner.motion, inner.node, outer.node));
      mass(outer.unknown, inner.unknown) += entry;
      if (inner.node != outer.node) mass(inner.unknown, outer.unknown) += entry;
    }
  }
  return mass;
}

}  // namespace flexarm
