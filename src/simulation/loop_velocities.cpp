#include "simulation/loop_velocities.h"

#include <algorithm>
#include <cmath>

#include "analysis/element_matrices.h"
#include "analysis/linearised_motion.h"
#include "joints/closure_maps.h"
#include "joints/joint_kinematics.h"
#include "simulation/observables.h"

namespace flexarm {
namespace {

/// Compliance of the loops, relative to the inverse of the whole mass. At and near a dead point the constraints depend
/// on each other. The compliance makes sure that no velocity changes by more than some hundred times the rate that is
/// to be removed. Elsewhere each round leaves about this part of an opening.
constexpr double kGive = 1e-4;
constexpr int kRounds = 6;

double unit_of(const Model& model, const ClosureConstraint& constraint) {
  return constraint.kind == ClosureConstraint::Kind::Gap ? model.length_scale : 1.0;
}

ClosurePoses ends(const LoopClosure& closure, const std::vector<NodePose>& poses) {
  return {closure.parent < 0 ? kWorld : poses[closure.parent], poses[closure.child]};
}

double rate_of(const LoopClosure& closure, const ClosureRows& rows, const std::vector<Vector6>& velocities) {
  const double of_child = rows.child.dot(velocities[closure.child]);
  return closure.parent < 0 ? of_child : of_child + rows.parent.dot(velocities[closure.parent]);
}

/// The tangent's diagonal entry of a released coordinate.
double& diagonal(const Model& model, const DegreesOfFreedom& dof, SparseTangent& tangent, int joint, int component) {
  const int count = released_count(model.joints[joint].kind);
  return tangent.diagonal_block(dof.variable_of_joint(joint))[component * count + component];
}

/// Maps of all joints at a state, for a zero residual.
JointMaps joint_maps(const Model& model, const DegreesOfFreedom& dof, const State& state) {
  JointMaps maps;
  std::vector<NodePose> nodes;
  for (const NodeState& node : state.nodes) nodes.push_back(node_pose(node));
  maps.folds.resize(model.joints.size());
  maps.slides.resize(model.joints.size());
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointMap& joint = model.joints[j];
    if (joint.kind == JointMapKind::Slide)
      slide_variational_maps(model.slide_lines[joint.line], nodes, state.released[j].displacement[0], Vector6::Zero(),
                             maps.slides[j]);
    else
      variational_maps(joint, joint_pose(joint, nodes, state.released[j]), Vector6::Zero(), maps.folds[j]);
  }
  for (const DegreesOfFreedom::Mimic& mimic : dof.mimics) {
    const Coordinate& following = model.coordinates[mimic.coordinate];
    const int master = model.coordinates[following.mimicked].joint;
    const double slope = following.mimic.derivative(state.released[master].displacement[0]);
    maps.mimics.push_back({slope, slope, 0});
  }
  return maps;
}

/// Adds the mass matrix of nodes and coordinates, before slaves are folded. Of the rotors it contains those that turn
/// with their coordinates.
void add_mass(const Model& model, const DegreesOfFreedom& dof, const State& state, SparseTangent& mass) {
  for_each_element(model.beams,
                   [&](const auto& element) { add_element(mass, element.first_block, mass_matrix(element, state)); });
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const NodalInertia& inertia = model.inertias[i];
    const Matrix3 rotation = state.nodes[i].orientation.toRotationMatrix();
    Eigen::Map<Matrix6> block(mass.diagonal_block(static_cast<int>(i)));
    block.topLeftCorner<3, 3>().diagonal().array() += inertia.mass;
    block.bottomRightCorner<3, 3>() += rotation * inertia.rotary * rotation.transpose();
  }
  for (const ActuatorTerms& terms : actuator_terms(model, state))
    diagonal(model, dof, mass, terms.joint, terms.component) += terms.mass;
}

/// Folds slaves into their masters, and coordinates that follow others into these.
void fold(const Model& model, const JointMaps& maps, SparseTangent& tangent) {
  for (int j = static_cast<int>(model.joints.size()) - 1; j >= 0; --j) {
    if (model.joints[j].kind == JointMapKind::Slide)
      tangent.fold(j, maps.slides[j]);
    else
      tangent.fold(j, maps.folds[j]);
  }
  tangent.fold_mimics(maps.mimics);
  tangent.finish();
}

/// The mass matrix M and the constraint matrix B in one system, for all unknowns of a step.
class ClosingImpulses {
 public:
  ClosingImpulses(const Model& model, const DegreesOfFreedom& dof, const State& state,
                  const std::vector<NodePose>& poses)
      : model_(model),
        dof_(dof),
        state_(state),
        poses_(poses),
        maps_(joint_maps(model, dof, state)),
        system_(model, dof) {
    system_.set_zero();
    add_mass(model, dof, state, system_);
    ClosureMaps maps;
    for (int k = 0; k < static_cast<int>(model.closures.size()); ++k)
      for (int i = 0; i < count(k); ++i) {
        const LoopClosure& closure = model.closures[k];
        closure_maps(closure, closure.constraints[i], ends(closure, poses), ends(closure, poses), 1, maps);
        system_.add_closure(k, i, 0, maps);
        const double unit = unit_of(model, closure.constraints[i]) / model.length_scale;
        system_.diagonal_block(dof.variable_of_closure(k))[i * count(k) + i] -= kGive * unit * unit / mass_of(model);
      }
    fold(model, maps_, system_);
    is_solvable_ = system_.factorise();
  }

  /// Adds the change of velocities that closes the loops. Returns false if the equations have no solution.
  bool close(const std::vector<Vector6>& velocities, VelocityChange& change) {
    if (!is_solvable_) return false;
    Eigen::VectorXd solution = Eigen::VectorXd::Zero(dof_.unknowns);
    for (int k = 0; k < static_cast<int>(model_.closures.size()); ++k)
      for (int i = 0; i < count(k); ++i) {
        const LoopClosure& closure = model_.closures[k];
        const ClosureRows rows = closure_rows(closure, closure.constraints[i], ends(closure, poses_));
        solution[dof_.equation[dof_.first[dof_.variable_of_closure(k)] + i]] = -rate_of(closure, rows, velocities);
      }
    if (!system_.solve(solution)) return false;
    add(solution, change);
    return true;
  }

 private:
  int count(int closure) const { return static_cast<int>(model_.closures[closure].constraints.size()); }

  void add(const Eigen::VectorXd& solution, VelocityChange& change) const {
    const auto value = [&](int scalar) { return dof_.equation[scalar] < 0 ? 0.0 : solution[dof_.equation[scalar]]; };
    std::vector<ReleasedVector> rates;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      ReleasedVector& own = rates.emplace_back(released_count(model_.joints[j].kind));
      for (int k = 0; k < own.size(); ++k) own[k] = value(dof_.first[dof_.variable_of_joint(j)] + k);
    }
    for (std::size_t m = 0; m < dof_.mimics.size(); ++m) {
      const Coordinate& following = model_.coordinates[dof_.mimics[m].coordinate];
      const Coordinate& leading = model_.coordinates[following.mimicked];
      rates[following.joint][following.component] = maps_.mimics[m].right * rates[leading.joint][leading.component];
    }
    std::vector<Vector6> nodes(model_.nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (int k = 0; k < 6; ++k) nodes[i][k] = value(dof_.first[i] + k);
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j)
      nodes[model_.joints[j].slave] = slave_velocity(model_, j, poses_, state_.released[j], nodes).with(rates[j]);
    for (std::size_t i = 0; i < nodes.size(); ++i) change.nodes[i] += nodes[i];
    for (std::size_t j = 0; j < rates.size(); ++j) change.rates[j] += rates[j];
  }

  const Model& model_;
  const DegreesOfFreedom& dof_;
  const State& state_;
  const std::vector<NodePose>& poses_;
  JointMaps maps_;
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
  for (std::size_t k = 0; k < model.closures.size(); ++k) {
    const LoopClosure& closure = model.closures[k];
    for (const auto* constraints : {&closure.constraints, &closure.implied})
      for (const ClosureConstraint& constraint : *constraints) {
        const ClosureRows rows = closure_rows(closure, constraint, ends(closure, poses));
        const double rate = std::abs(rate_of(closure, rows, velocities)) / unit_of(model, constraint);
        if (rate > opening.rate) opening.rate = rate, opening.closure = static_cast<int>(k);
      }
  }
  return opening;
}

VelocityChange closing_change(const Model& model, const DegreesOfFreedom& dof, const State& state,
                              const std::vector<Vector6>& velocities) {
  if (model.closures.empty()) return {};
  std::vector<NodePose> poses;
  for (const NodeState& node : state.nodes) poses.push_back(node_pose(node));
  LoopOpening opening = opening_of(model, poses, velocities);
  if (opening.is_round_off()) return {};
  ClosingImpulses impulses(model, dof, state, poses);
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
