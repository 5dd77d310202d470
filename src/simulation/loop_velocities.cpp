#include "simulation/loop_velocities.h"

#include <algorithm>
#include <cmath>

#include "analysis/folded_sums.h"
#include "simulation/observables.h"

namespace flexarm {
namespace {

/// Compliance of the loops, relative to the inverse of the whole mass. At and near a dead point the constraints depend
/// on each other. The compliance makes sure that no velocity changes by more than some hundred times the rate that is
/// to be removed. Elsewhere each round leaves about this part of an opening.
constexpr double kGive = 1e-4;
constexpr int kRounds = 6;

double rate_of(const LoopClosure& closure, const ClosureRows& rows, const std::vector<Vector6>& velocities) {
  const double of_child = rows.child.dot(velocities[closure.child]);
  return closure.parent < 0 ? of_child : of_child + rows.parent.dot(velocities[closure.parent]);
}

/// The mass matrix M and the constraint matrix B in one system, for all unknowns of a step.
class ClosingImpulses {
 public:
  ClosingImpulses(const Kinematics& kinematics, const State& state)
      : kinematics_(kinematics),
        model_(kinematics.model()),
        dof_(kinematics.degrees_of_freedom()),
        system_(model_, dof_) {
    system_.set_zero();
    add_mass(kinematics, state, system_);
    ClosureMaps maps;
    for_each_multiplier(model_, dof_, [&](int k, int i, int) {
      const LoopClosure& closure = model_.closures[k];
      const ClosurePoses poses = closure_poses(closure, kinematics.nodes());
      closure_maps(closure, closure.constraints[i], poses, poses, 1, maps);
      system_.add_closure(k, i, 0, maps);
      const double unit = constraint_scale(model_, closure.constraints[i]) / model_.length_scale;
      const int variable = dof_.variable_of_closure(k);
      system_.diagonal_block(variable)[i * dof_.size[variable] + i] -= kGive * unit * unit / mass_of(model_);
    });
    fold(kinematics, system_);
    is_solvable_ = system_.factorise();
  }

  /// Adds the change of velocities that closes the loops. Returns false if the equations have no solution.
  bool close(const std::vector<Vector6>& velocities, VelocityChange& change) {
    if (!is_solvable_) return false;
    Eigen::VectorXd solution = Eigen::VectorXd::Zero(dof_.unknowns);
    for_each_multiplier(model_, dof_, [&](int k, int i, int equation) {
      const LoopClosure& closure = model_.closures[k];
      const ClosurePoses poses = closure_poses(closure, kinematics_.nodes());
      solution[equation] = -rate_of(closure, closure_rows(closure, closure.constraints[i], poses), velocities);
    });
    if (!system_.solve(solution)) return false;
    add(solution, change);
    return true;
  }

 private:
  void add(const Eigen::VectorXd& solution, VelocityChange& change) const {
    Eigen::VectorXd scalars = Eigen::VectorXd::Zero(dof_.scalar_count);
    for (int scalar = 0; scalar < dof_.scalar_count; ++scalar)
      if (dof_.equation[scalar] >= 0) scalars[scalar] = solution[dof_.equation[scalar]];
    kinematics_.complete(scalars);
    for (std::size_t i = 0; i < change.nodes.size(); ++i) change.nodes[i] += scalars.segment<6>(dof_.first[i]);
    for (std::size_t j = 0; j < change.rates.size(); ++j)
      change.rates[j] +=
          scalars.segment(dof_.first[dof_.variable_of_joint(static_cast<int>(j))], change.rates[j].size());
  }

  const Kinematics& kinematics_;
  const Model& model_;
  const DegreesOfFreedom& dof_;
  SparseTangent system_;
  bool is_solvable_ = false;
};

VelocityChange no_change(const Model& model) {
  VelocityChange change;
  change.nodes.assign(model.nodes.size(), Vector6::Zero());
  for (const JointMap& joint : model.joints) change.rates.push_back(ReleasedVector::Zero(released_count(joint.kind)));
  return change;
}

std::vector<Vector6> sum(std::vector<Vector6> velocities, const VelocityChange& change) {
  for (std::size_t i = 0; i < change.nodes.size(); ++i) velocities[i] += change.nodes[i];
  return velocities;
}

/// Angular velocities at the mass points of beams, interpolated from those of the nodes.
std::vector<MassPointState> mass_points(const Model& model, const std::vector<NodePose>& poses,
                                        const std::vector<Vector6>& velocities) {
  Model placed = model;
  placed.nodes = poses;
  placed.initial_velocity = velocities;
  return initial_state(placed).study.mass_points;
}

}  // namespace

LoopOpening opening_of(const Model& model, const std::vector<NodePose>& poses, const std::vector<Vector6>& velocities) {
  LoopOpening opening;
  for (const Vector6& velocity : velocities)
    opening.fastest =
        std::max({opening.fastest, velocity.head<3>().norm() / model.length_scale, velocity.tail<3>().norm()});
  for_each_constraint(model, Constraints::All, [&](const LoopClosure& closure, const ClosureConstraint& constraint) {
    const ClosureRows rows = closure_rows(closure, constraint, closure_poses(closure, poses));
    const double rate = std::abs(rate_of(closure, rows, velocities)) / constraint_scale(model, constraint);
    if (rate > opening.rate) opening.rate = rate, opening.closure = static_cast<int>(&closure - model.closures.data());
  });
  return opening;
}

VelocityChange closing_change(const Model& model, const DegreesOfFreedom& dof, const State& state,
                              const std::vector<Vector6>& velocities) {
  if (model.closures.empty()) return {};
  Configuration configuration = configuration_of(state);
  LoopOpening opening = opening_of(model, configuration.nodes, velocities);
  if (opening.is_round_off()) return {};
  const Kinematics kinematics(model, dof, std::move(configuration));
  const std::vector<NodePose>& poses = kinematics.nodes();
  ClosingImpulses impulses(kinematics, state);
  VelocityChange best;
  for (int round = 0; round < kRounds && !opening.is_round_off(); ++round) {
    VelocityChange next = best.is_nothing() ? no_change(model) : best;
    if (!impulses.close(sum(velocities, best), next)) break;
    const LoopOpening left = opening_of(model, poses, sum(velocities, next));
    if (!(left.rate < opening.rate)) break;
    opening = left;
    best = std::move(next);
  }
  return best;
}

State with_closed_loops(const Model& model, const DegreesOfFreedom& dof, State state) {
  std::vector<Vector6> velocities;
  for (const NodeState& node : state.nodes) velocities.push_back(spatial_velocity(node));
  const VelocityChange change = closing_change(model, dof, state, velocities);
  if (change.is_nothing()) return state;
  std::vector<NodePose> poses;
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    NodeState& node = state.nodes[i];
    poses.push_back(node_pose(node));
    node.velocity += change.nodes[i].head<3>();
    node.angular_velocity += node.orientation.conjugate() * Vector3(change.nodes[i].tail<3>());
  }
  const std::vector<MassPointState> turned = mass_points(model, poses, change.nodes);
  for (std::size_t i = 0; i < state.study.mass_points.size(); ++i)
    state.study.mass_points[i].angular_velocity += turned[i].angular_velocity;
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const Actuator& actuator = model.actuators[i];
    if (actuator.drive.gear) continue;  // no impulse passes through an elastic gear
    const Coordinate& coordinate = model.coordinates[actuator.coordinate];
    if (is_held(model, coordinate)) continue;
    state.actuators[i].rate += change.rates[coordinate.joint][coordinate.component];
    if (!actuator.gyroscope) continue;
    const auto& [node, axis, inertia, ratio] = *actuator.gyroscope;
    state.actuators[i].rate += (poses[node].rotation * axis).dot(change.nodes[node].tail<3>()) / ratio;
  }
  return state;
}

}  // namespace flexarm
