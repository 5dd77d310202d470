#include "elements/line_ends.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "math/so3.h"

namespace flexarm {
namespace {

using so3::hat;

/// Returns a length that is safe to divide by. A line of length zero has no direction, and then exerts no force.
double divisor(double length) {
  return std::max(length, std::numeric_limits<double>::min());
}

NodePose pose_of(const std::vector<NodePose>& nodes, int node) {
  return node < 0 ? NodePose() : nodes[node];
}

NodePose pose_of(const State& state, int node) {
  return node < 0 ? NodePose() : node_pose(state.nodes[node]);
}

}  // namespace

std::vector<int> nodes_of(const NodePoint& first, const NodePoint& second) {
  assert((first.node >= 0 || second.node >= 0) && first.node != second.node);
  std::vector<int> nodes;
  for (const NodePoint* point : {&first, &second})
    if (point->node >= 0) nodes.push_back(point->node);
  return nodes;
}

LineEnds::LineEnds(const NodePoint& child, const NodePoint& parent, const NodePose& child_pose,
                   const NodePose& parent_pose)
    : child_arm(child_pose.rotation * child.arm),
      parent_arm(parent_pose.rotation * parent.arm),
      distance(child_pose.position + child_arm - parent_pose.position - parent_arm) {}

LineEnds::LineEnds(const NodePoint& child, const NodePoint& parent, const std::vector<NodePose>& poses)
    : LineEnds(child, parent, pose_of(poses, child.node), pose_of(poses, parent.node)) {}

LineEnds::LineEnds(const NodePoint& child, const NodePoint& parent, const State& state)
    : LineEnds(child, parent, pose_of(state, child.node), pose_of(state, parent.node)) {}

LineEnds LineEnds::mean(const LineEnds& a, const LineEnds& b, double weight) {
  const auto mix = [&](const Vector3& x, const Vector3& y) { return Vector3((1 - weight) * x + weight * y); };
  return {mix(a.child_arm, b.child_arm), mix(a.parent_arm, b.parent_arm), mix(a.distance, b.distance)};
}

Vector12 LineEnds::gradient() const {
  const Vector3 along = distance / divisor(length());
  Vector12 gradient;
  gradient << along, child_arm.cross(along), -along, -parent_arm.cross(along);
  return gradient;
}

LineStep::LineStep(const LineEnds& begin, const LineEnds& end, bool at_end)
    : weight_(at_end ? 1 : 0.5),
      mean_(LineEnds::mean(begin, end, weight_)),
      length_(divisor((1 - weight_) * begin.length() + weight_ * end.length())),
      end_(end) {}

Vector12 LineStep::direction() const {
  Vector12 direction;
  act(1, 0, direction, nullptr);
  return direction;
}

void LineStep::act(double tension, double slope, Vector12& residual, Matrix12* tangent) const {
  const double density = tension / length_;
  const Vector3 force = density * mean_.distance;
  residual << force, mean_.child_arm.cross(force), -force, -mean_.parent_arm.cross(force);
  if (!tangent) return;

  // Derivative of the distance at the end with respect to {displacement, spin} of child and parent.
  Eigen::Matrix<double, 3, 12> distance;
  distance << Matrix3::Identity(), -hat(end_.child_arm), -Matrix3::Identity(), hat(end_.parent_arm);
  const double density_slope = (slope - weight_ * density) / length_;
  const Vector3 along = density_slope / divisor(end_.length()) * end_.distance;
  const Eigen::Matrix<double, 3, 12> d_force =
      weight_ * density * distance + mean_.distance * (along.transpose() * distance);
  *tangent << d_force, hat(mean_.child_arm) * d_force, -d_force, -hat(mean_.parent_arm) * d_force;
  // The arms rotate with their nodes.
  tangent->block<3, 3>(3, 3) += weight_ * hat(force) * hat(end_.child_arm);
  tangent->block<3, 3>(9, 9) -= weight_ * hat(force) * hat(end_.parent_arm);
}

}  // namespace flexarm
