#include "simulation/freed_joints.h"

#include <fmt/format.h>

#include "joints/joint_kinematics.h"
#include "simulation/inside.h"
#include "simulation/linear_names.h"

namespace flexarm {
namespace {

/// Builds the scene so that held joints get nodes of their own: constant motions become functions of time.
Simulation built_free(const Simulation& held) {
  scene::SceneDescription scene = held.scene();
  for (scene::PrescribedMotion& motion : scene.motions)
    if (const std::optional<double> value = motion.position.constant())
      motion.position = TimeFunction::parse(fmt::format("0:{}", *value));
  return Simulation(std::move(scene));
}

/// Computes the state of the freed simulation. Nodes that no joint places belong to beams, and the beam of a link has
/// the same nodes in both models.
class FreedState {
 public:
  FreedState(const Simulation& held, const Simulation& freed)
      : from_(model_of(held)), to_(model_of(freed)), state_(state_of(held)), rates_(published_rates(held)) {}

  State state(const Simulation& freed) const {
    std::vector<NodePose> poses = to_.nodes;
    std::vector<Vector6> velocities(poses.size(), Vector6::Zero());
    for (std::size_t link = 0; link < to_.links.size(); ++link) {
      if (!to_.links[link].beam) continue;
      const int first = to_.links[link].frame.node, count = to_.links[link].beam->tip.node - first + 1;
      for (int i = 0; i < count; ++i) {
        const int node = from_.links[link].frame.node + i;
        poses[first + i] = node_pose(state_.nodes[node]);
        velocities[first + i] = rates_.nodes[node];
      }
    }
    std::vector<Released> released = to_.initial_released;
    std::vector<ReleasedVector> rates;
    for (const JointMap& joint : to_.joints) rates.push_back(ReleasedVector::Zero(released_count(joint.kind)));
    for (std::size_t i = 0; i < to_.coordinates.size(); ++i) {
      const Coordinate& coordinate = to_.coordinates[i];
      released[coordinate.joint] = state_.released[from_.coordinates[i].joint];
      rates[coordinate.joint][coordinate.component] = rates_.coordinates[i];
    }
    for (int j = 0; j < static_cast<int>(to_.joints.size()); ++j) {
      const int slave = to_.joints[j].slave;
      poses[slave] = slave_pose(to_, j, poses, released[j]);
      velocities[slave] = slave_velocity(to_, j, poses, released[j], velocities).with(rates[j]);
    }
    MechanismMotion motion{{{poses, released}, {}}, {}, {}};
    motion.rates.nodes = velocities;
    for (const ActuatorState& actuator : state_.actuators) {
      motion.rotors.push_back(actuator.angle);
      motion.rates.rotors.push_back(actuator.rate);
    }
    State out = start_at(freed, motion);
    out.time = state_.time;
    out.steps = state_.steps;
    out.origin = state_.origin;
    out.study.mass_points = state_.study.mass_points;
    out.strain_memory = state_.strain_memory;
    out.branch_strains = state_.branch_strains;
    out.commands = state_.commands;
    out.actuators = state_.actuators;
    for (const NodalLoad& wrench : state_.wrenches)
      if (wrench.link >= 0) out.wrenches.push_back(placed(wrench));
    return out;
  }

 private:
  NodalLoad placed(const NodalLoad& wrench) const {
    const Attachment &before = from_.links[wrench.link].frame, &after = to_.links[wrench.link].frame;
    NodalLoad out = wrench;
    out.node = after.node + wrench.node - before.node;
    if (to_.links[wrench.link].beam) return out;
    const Pose change = after.offset * before.offset.inverse();
    out.arm = change * wrench.arm;
    if (!wrench.follows) return out;
    out.force = change.orientation * wrench.force;
    out.moment = change.orientation * wrench.moment;
    return out;
  }

  const Model &from_, &to_;
  const State& state_;
  KnownRates rates_;
};

}  // namespace

Simulation with_joints_freed(const Simulation& held) {
  Simulation freed = built_free(held);
  show(FreedState(held, freed).state(freed), freed);
  return freed;
}

}  // namespace flexarm
