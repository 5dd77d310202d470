#include "simulation/shown_wrenches.h"

#include "joints/joint_kinematics.h"
#include "model/carried_origin.h"

namespace flexarm {
namespace {

/// A load at `value` of its history. `node`: its pose about the origin of the state, `velocity`: its {v, w}.
ActingWrench shown(const NodalLoad& load, double value, const NodePose& node, const Vector6& velocity,
                   const Vector3& origin) {
  const Quaternion axes = load.follows ? node.orientation : Quaternion::Identity();
  const Vector3 arm = node.rotation * load.arm;
  ActingWrench out{origin + node.position + arm, {axes * (value * load.force), axes * (value * load.moment)}};
  const Vector3 point_velocity = velocity.head<3>() + velocity.tail<3>().cross(arm);
  out.wrench.force += load.pull.stiffness * (load.pull.target - out.position) - load.pull.damping * point_velocity;
  return out;
}

}  // namespace

void effort_wrenches(const Model& model, const State& state, std::vector<ActingWrench>& wrenches) {
  std::vector<NodePose> nodes;
  nodes.reserve(state.nodes.size());
  for (const NodeState& node : state.nodes) nodes.push_back(node_pose(node));
  const std::vector<Vector6> at_rest(nodes.size(), Vector6::Zero());
  wrenches.clear();
  for (const Coordinate& coordinate : model.coordinates) {
    const JointMap& joint = model.joints[coordinate.joint];
    const SlaveVelocity slave =
        slave_velocity(model, coordinate.joint, nodes, state.released[coordinate.joint], at_rest);
    const Vector6 column = slave.columns.col(coordinate.component);
    ActingWrench& out = wrenches.emplace_back();
    out.position = moved_origin(joint, slave_node_pose(joint, nodes));
    // The effort's power is that of the wrench: a moment where the coordinate turns, a force where it only travels.
    const bool turns = joint.kind != JointMapKind::Slide && !column.tail<3>().isZero(0);
    const Vector3 rate = turns ? column.tail<3>() : column.head<3>();
    const double square = rate.squaredNorm();
    if (square > 0) (turns ? out.wrench.moment : out.wrench.force) = rate / square;
  }
}

void outside_wrenches(const MotionView& view, PublishedMotion& motion, std::vector<ActingWrench>& wrenches) {
  wrenches.clear();
  const std::vector<NodalLoad>&loads = view.model.loads, &applied = view.state.wrenches;
  if (loads.empty() && applied.empty()) return;
  const std::vector<Vector6>& velocities = motion.velocities(view).nodes();
  const Vector3 origin = world_origin(view.model, view.state);
  const auto add = [&](const NodalLoad& load, double value) {
    wrenches.push_back(shown(load, value, node_pose(view.state.nodes[load.node]), velocities[load.node], origin));
  };
  for (const NodalLoad& load : loads) add(load, view.model.histories[load.history](view.state.time));
  for (const NodalLoad& load : applied) add(load, 1);
}

}  // namespace flexarm
