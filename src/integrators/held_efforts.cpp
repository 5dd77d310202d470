#include "integrators/held_efforts.h"

#include <cassert>

#include "elements/node_motion.h"
#include "joints/joint_kinematics.h"

namespace flexarm {
namespace {

/// Momentum of the held links at one end of the step; world axes, angular momentum about their centre of mass.
Vector6 body_momentum(const HeldJoint& held, const NodeState& node) {
  const Vector3& W = node.angular_velocity;
  Vector6 out;
  out << held.mass * (node.velocity + node.orientation * W.cross(held.centre)), node.orientation * (held.inertia * W);
  return out;
}

}  // namespace

Vector6 momentum_rate(const HeldJoint& held, const NodeState& node) {
  const Vector3 &W = node.angular_velocity, &A = node.angular_acceleration, &c = held.centre;
  Vector6 out;
  out << held.mass * (node.acceleration + node.orientation * Vector3(A.cross(c) + W.cross(W.cross(c)))),
      momentum_rate(node.orientation.toRotationMatrix(), held.inertia, W, A);
  return out;
}

void HeldEfforts::add_inertia(const HeldJoint& held, int node, Vector6& wrench) const {
  const StepConfiguration& step = configuration_;
  const Scheme& scheme = step.scheme();
  const NodeState& begin = step.state().nodes[node];
  NodeState end = family_.motion_at_end(node);
  if (scheme.is_incremental()) {
    wrench += (body_momentum(held, end) - body_momentum(held, begin)) / step.step();
    return;
  }
  // Accelerations of the Hilber-Hughes-Taylor family belong to instants before the ends; extrapolate them to the end.
  const double later = 1 / step.effort_weight() - 1;
  end.acceleration += later * (end.acceleration - begin.acceleration);
  end.angular_acceleration += later * (end.angular_acceleration - begin.angular_acceleration);
  wrench += momentum_rate(held, end);
}

double HeldEfforts::effort(const HeldJoint& held, const ReducedResidual& residual) {
  assert(held.coordinate >= 0);
  const StepConfiguration& step = configuration_;
  const Model& model = step.model();
  const int j = model.coordinates[held.coordinate].joint, node = model.joints[j].master;
  Vector6 wrench = Vector6::Zero();  // about the centre of mass
  wrench.head<3>() = -histories_.factor * held.mass * model.gravity;
  if (node >= 0) add_inertia(held, node, wrench);
  // Arm from the node, weighted as in the joints' maps: the mean over the step, or the arm at its end.
  const double end = step.scheme().arm_weight();
  const auto arm_in = [&](const std::vector<NodePose>& nodes) {
    return Vector3(master_pose(model.joints[j], nodes).rotation * held.centre);
  };
  const Vector3 arm = end * arm_in(step.end()) + (1 - end) * arm_in(step.begin());
  wrench.tail<3>() += arm.cross(wrench.head<3>());
  wrench -= forces_.loads_on(held.links);
  for (const int outboard : held.outboard)
    wrench += reactions_.transmitted(residual, {outboard, -1, false, {node, Pose()}});
  step.joint_maps(j, wrench, maps_, false);
  return maps_.left.col(0).dot(wrench);
}

}  // namespace flexarm
