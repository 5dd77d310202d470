#include "simulation/wrenches.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "joints/joint_kinematics.h"
#include "model/carried_origin.h"
#include "simulation/entry.h"

namespace flexarm {
namespace {

/// The node that carries the point, and the link's frame relative to this node.
Attachment carrier_of(const Model& model, const LinkFrame& link, const Vector3& point) {
  if (!link.beam) return link.frame;
  const auto pose = [&](int node) { return Pose{model.nodes[node].position, model.nodes[node].orientation}; };
  const Pose origin = pose(link.frame.node) * link.frame.offset;
  const Vector3 place = origin.position + origin.orientation * point;
  int nearest = link.frame.node;
  for (int node = nearest + 1; node <= link.beam->tip.node; ++node)
    if ((model.nodes[node].position - place).norm() < (model.nodes[nearest].position - place).norm()) nearest = node;
  return {nearest, pose(nearest).inverse() * origin};
}

}  // namespace

NodalLoad placed_wrench(const Model& model, const AppliedWrench& wrench) {
  const LinkFrame& link = entry(model.links, wrench.link, "link");
  const auto& [force, moment] = wrench.wrench;
  if (!wrench.at.allFinite() || !force.allFinite() || !moment.allFinite())
    throw std::invalid_argument(fmt::format("the wrench on link '{}' is not finite", link.name));
  const Pull& pull = wrench.pull;
  if (!pull.target.allFinite() || !std::isfinite(pull.stiffness) || !std::isfinite(pull.damping))
    throw std::invalid_argument(fmt::format("the pull on link '{}' is not finite", link.name));
  if (pull.stiffness < 0 || pull.damping < 0)
    throw std::invalid_argument(fmt::format("the pull on link '{}' has stiffness {} N/m and damping {} N s/m, not >= 0",
                                            link.name, pull.stiffness, pull.damping));
  if (link.frame.node < 0) throw std::invalid_argument(fmt::format("link '{}' is fixed to the world", link.name));
  const Attachment carrier = carrier_of(model, link, wrench.at);
  NodalLoad load = load_on(carrier.node, carrier.offset, wrench.at, force, moment, wrench.follows);
  load.pull = pull;
  load.link = static_cast<int>(wrench.link);
  return load;
}

void require_no_pulls(const Scheme& scheme, const std::vector<NodalLoad>& wrenches) {
  const auto pulls = [](const NodalLoad& wrench) { return wrench.pull.acts(); };
  if (std::none_of(wrenches.begin(), wrenches.end(), pulls)) return;
  if (scheme.hht != HhtForm::None)
    throw std::invalid_argument("schemes that interpolate forces in time (hht1, hht2, hht3) have no pulls");
}

// ---------------------------------------------------------------- for displays

namespace {

/// The wrench of a load whose function of time has this `value`. `node`: the node's pose relative to the state's
/// origin, `velocity`: its {v, w}.
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
    // The wrench has the power of the effort: it is a moment if the coordinate turns, and a force if it only travels.
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
