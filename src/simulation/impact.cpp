#include "simulation/impact.h"

#include <stdexcept>

#include "model/degrees_of_freedom.h"
#include "simulation/loop_velocities.h"
#include "simulation/observables.h"

namespace flexarm {
namespace {

/// Largest rate at which the closed joint may still open, relative to the fastest motion.
constexpr double kHolds = 1e-10;

/// All six constraints that hold two frames in their present relative pose.
LoopClosure weld_between(const State& state, const Attachment& parent, const Attachment& child) {
  const Pose frame = attached_pose(state, child);
  const auto pose_of = [&](int node) {
    return node < 0 ? Pose() : Pose{state.nodes[node].position, state.nodes[node].orientation};
  };
  const Pose on_parent = pose_of(parent.node).inverse() * frame;
  LoopClosure weld;
  weld.name = "attached";
  weld.parent = parent.node;
  weld.child = child.node;
  weld.parent_arm = on_parent.position;
  weld.child_arm = child.offset.position;
  for (int k = 0; k < 3; ++k) {
    weld.constraints.push_back({ClosureConstraint::Kind::Gap, Vector3::Unit(k), Vector3::Zero(), 0});
    const Vector3 other = child.offset.orientation * (on_parent.orientation.conjugate() * Vector3::Unit((k + 1) % 3));
    weld.constraints.push_back({ClosureConstraint::Kind::Direction, Vector3::Unit(k), other, 0});
  }
  return weld;
}

/// Adds the beams' rotary inertia to the nodes, for schemes that lump it there.
void lump_rotary_inertia(Model& model) {
  for (NodalInertia& inertia : model.inertias) inertia.rotary += inertia.beam_rotary;
  for_each_element(model.beams, [](auto& element) {
    for (auto& point : element.mass_points) point.inertia.setZero();
  });
}

}  // namespace

State after_impact(const Model& model, const Scheme& scheme, const State& state, const Attachment& parent,
                   const Attachment& child) {
  Model welded = model;
  if (scheme.nodal_rotary_inertia) lump_rotary_inertia(welded);
  welded.closures.push_back(weld_between(state, parent, child));
  State after = with_closed_loops(welded, DegreesOfFreedom(welded), state);
  std::vector<NodePose> poses;
  std::vector<Vector6> velocities;
  for (const NodeState& node : after.nodes) {
    poses.push_back(node_pose(node));
    velocities.push_back(spatial_velocity(node));
  }
  const LoopOpening left = opening_of(welded, poses, velocities);
  if (left.rate > kHolds * left.fastest)
    throw std::invalid_argument("prescribed motions allow no velocities with which the two could move on as one body");
  return after;
}

}  // namespace flexarm
