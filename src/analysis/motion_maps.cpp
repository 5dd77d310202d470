#include "analysis/motion_maps.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <stdexcept>

#include "math/least_squares.h"
#include "math/picked.h"
#include "math/so3.h"

namespace flexarm {

MechanismPose pose_of(const State& state) {
  return {configuration_of(state), state.force_memory};
}

State state_at(const MechanismPose& pose) {
  State state;
  for (const NodePose& node : pose.nodes) {
    state.nodes.emplace_back();
    state.nodes.back().position = node.position;
    state.nodes.back().orientation = node.orientation;
  }
  state.released = pose.released;
  state.force_memory = pose.force_memory;
  return state;
}

MotionMaps::MotionMaps(const Model& model, const DegreesOfFreedom& dof)
    : model_(model),
      dof_(dof),
      constraint_count_(multiplier_count(model)),
      rows_(dof.scalar_count - constraint_count_),  // multipliers come last
      columns_(dof.unknowns - constraint_count_) {
  sort_nodes();
}

void MotionMaps::sort_nodes() {
  enum class Mark { New, Open, Done };
  std::vector<Mark> marks(model_.nodes.size(), Mark::New);
  carriers_.assign(model_.nodes.size(), -1);
  const std::function<void(int)> visit = [&](int node) {
    if (node < 0 || marks[node] != Mark::New) return;
    marks[node] = Mark::Open;
    if (const int j = dof_.slave_joint[node]; j >= 0) {
      const JointMap& joint = model_.joints[j];
      if (joint.kind == JointMapKind::Slide)
        for (const int master : model_.slide_lines[joint.line].nodes) visit(master);
      else
        visit(joint.master);
    } else {
      int carrier = model_.node_parents[node];
      while (carrier >= 0 && dof_.slave_joint[carrier] < 0) carrier = model_.node_parents[carrier];
      visit(carrier);
      // If the carrier itself follows this node, it is not marked as done.
      if (carrier >= 0 && marks[carrier] == Mark::Done) carriers_[node] = carrier;
    }
    marks[node] = Mark::Done;
    order_.push_back(node);
  };
  for (int node = 0; node < dof_.node_count; ++node) visit(node);
}

Eigen::MatrixXd MotionMaps::at(const MechanismPose& pose) const {
  assert(pose.nodes.size() == model_.nodes.size() && pose.released.size() == model_.joints.size_with_held());
  Eigen::MatrixXd maps = Eigen::MatrixXd::Zero(rows_, columns_);
  for (int scalar = 0; scalar < rows_; ++scalar)
    if (dof_.equation[scalar] >= 0) maps(scalar, dof_.equation[scalar]) = 1;
  const Kinematics kinematics(model_, dof_, pose);
  kinematics.move_followers(maps);
  for (const int node : order_) {
    if (const int j = dof_.slave_joint[node]; j >= 0) {
      kinematics.move_slave(j, maps);
      continue;
    }
    const int carrier = carriers_[node];
    if (carrier < 0) continue;
    const NodePose& frame = pose.nodes[carrier];
    auto own = maps.middleRows<6>(dof_.first[node]);
    for (const int k : {0, 3})
      for (int c = 0; c < 3; ++c) own.block<3, 1>(k, dof_.equation[dof_.first[node] + k + c]) = frame.rotation.col(c);
    const auto carried = maps.middleRows<6>(dof_.first[carrier]);  // like a rigid body
    own += carried;
    own.topRows<3>() -= so3::hat(Vector3(pose.nodes[node].position - frame.position)) * carried.bottomRows<3>();
  }
  for (int i = 0; i < dof_.node_count; ++i) {
    auto spins = maps.middleRows<3>(dof_.first[i] + 3);
    spins = (pose.nodes[i].rotation.transpose() * spins).eval();
  }
  return maps;
}

Eigen::MatrixXd MotionMaps::constraints(const MechanismPose& pose, const Eigen::MatrixXd& maps) const {
  assert(maps.rows() == rows_ && maps.cols() == columns_);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(constraint_count_, columns_);
  int row = 0;
  for_each_constraint(model_, Constraints::WithMultipliers, [&](const auto& closure, const auto& constraint) {
    const ClosureRows own = closure_rows(closure, constraint, closure_poses(closure, pose.nodes));
    const auto add = [&](int node, Vector6 by_motion) {  // maps have spins along the node's axes
      if (node < 0) return;
      by_motion.tail<3>() = (pose.nodes[node].rotation.transpose() * by_motion.tail<3>()).eval();
      rows.row(row) += by_motion.transpose() * maps.middleRows<6>(dof_.first[node]);
    };
    add(closure.child, own.child);
    add(closure.parent, own.parent);
    rows.row(row++) /= constraint_scale(model_, constraint);
  });
  return rows;
}

std::vector<int> MotionMaps::scalars_of_columns() const {
  std::vector<int> scalars(columns_);
  for (int scalar = 0; scalar < rows_; ++scalar)
    if (dof_.equation[scalar] >= 0) scalars[dof_.equation[scalar]] = scalar;
  return scalars;
}

MotionMaps::Split MotionMaps::split(const MechanismPose& pose, const std::vector<bool>& is_driven) const {
  assert(static_cast<int>(is_driven.size()) == columns_);
  Split out;
  Eigen::MatrixXd rows = constraints(pose, at(pose));
  const Eigen::VectorXd scales = scalar_scales(model_, dof_);
  const std::vector<int> scalars = scalars_of_columns();
  std::vector<int> candidates;
  for (int column = 0; column < columns_; ++column)
    if (!is_driven[column]) candidates.push_back(column), rows.col(column) *= scales[scalars[column]];
  if (rows.rows() > 0)
    for (const Eigen::Index i : independent_rows(picked_columns(rows, candidates).transpose(), kIndependent))
      out.dependent.push_back(candidates[i]);
  if (static_cast<Eigen::Index>(out.dependent.size()) != rows.rows())
    throw std::runtime_error("at a dead point, a loop cannot be linearised");
  std::sort(out.dependent.begin(), out.dependent.end());
  for (int column = 0; column < columns_; ++column)
    if (!std::binary_search(out.dependent.begin(), out.dependent.end(), column)) out.independent.push_back(column);
  return out;
}

Eigen::MatrixXd MotionMaps::allowed(const MechanismPose& pose, const Eigen::MatrixXd& maps,
                                    const std::vector<int>& independent) const {
  assert(std::is_sorted(independent.begin(), independent.end()));
  Eigen::MatrixXd allowed = Eigen::MatrixXd::Zero(columns_, static_cast<Eigen::Index>(independent.size()));
  for (std::size_t i = 0; i < independent.size(); ++i) allowed(independent[i], static_cast<Eigen::Index>(i)) = 1;
  if (constraint_count_ == 0) return allowed;
  std::vector<int> dependent;
  for (int column = 0; column < columns_; ++column)
    if (!std::binary_search(independent.begin(), independent.end(), column)) dependent.push_back(column);
  const Eigen::MatrixXd rows = constraints(pose, maps);
  add_to_rows(allowed, dependent, -square_solution(picked_columns(rows, dependent), picked_columns(rows, independent)));
  if (!allowed.allFinite()) throw std::runtime_error("the loops do not determine how their joints move");
  return allowed;
}

Eigen::MatrixXd MotionMaps::unknowns(const MechanismPose& pose, const Eigen::MatrixXd& maps) const {
  assert(maps.rows() == rows_ && maps.cols() == columns_);
  Eigen::MatrixXd unknowns(columns_, columns_);
  for (int scalar = 0; scalar < rows_; ++scalar)
    if (dof_.equation[scalar] >= 0) unknowns.row(dof_.equation[scalar]) = maps.row(scalar);
  for (int i = 0; i < dof_.node_count; ++i) {
    const int spin = dof_.first[i] + 3;
    if (dof_.equation[spin] < 0) continue;
    unknowns.middleRows<3>(dof_.equation[spin]) = pose.nodes[i].rotation * maps.middleRows<3>(spin);
  }
  return unknowns;
}

MechanismPose MotionMaps::moved(const MechanismPose& pose, const CoordinateRates& rates, double time) const {
  assert(rates.first.size() == columns_ && rates.second.size() == columns_);
  const Eigen::VectorXd way = time * rates.first + 0.5 * time * time * rates.second;
  const auto way_of = [&](int scalar) { return dof_.equation[scalar] < 0 ? 0.0 : way[dof_.equation[scalar]]; };
  MechanismPose out = pose;
  for (int j = 0; j < dof_.joint_count; ++j) {
    ReleasedVector own(released_count(model_.joints[j].kind));
    for (int k = 0; k < own.size(); ++k) own[k] = way_of(dof_.first[dof_.variable_of_joint(j)] + k);
    out.released[j] = updated(model_.joints[j], pose.released[j], own);
  }
  place_followers(model_, out.released);
  for (const int i : order_) {
    NodePose& node = out.nodes[i];
    if (const int j = dof_.slave_joint[i]; j >= 0) {
      node = slave_pose(model_, j, out.nodes, out.released[j]);
      node.orientation = so3::nearer_of_two(node.orientation, pose.nodes[i].orientation);
      continue;
    }
    Vector6 own;
    for (int k = 0; k < 6; ++k) own[k] = way_of(dof_.first[i] + k);
    const NodePose world, &before = carriers_[i] < 0 ? world : pose.nodes[carriers_[i]],
                          &after = carriers_[i] < 0 ? world : out.nodes[carriers_[i]];
    const Quaternion back = before.orientation.conjugate();
    node.position = after.position + after.orientation * (back * (node.position - before.position) + own.head<3>());
    node.orientation =
        (after.orientation * so3::exp_quaternion(own.tail<3>()) * (back * node.orientation)).normalized();
    node.rotation = node.orientation.toRotationMatrix();
  }
  return out;
}

MovingMatrix along(const std::function<Eigen::MatrixXd(double)>& at_time, double spacing) {
  assert(spacing >= 0);
  constexpr std::array<double, 4> kFirst = {4. / 5, -1. / 5, 4. / 105, -1. / 280};
  constexpr std::array<double, 4> kSecond = {8. / 5, -1. / 5, 8. / 315, -1. / 560};
  MovingMatrix out;
  out.value = at_time(0);
  out.first = out.second = Eigen::MatrixXd::Zero(out.value.rows(), out.value.cols());
  if (spacing == 0) return out;
  for (int k = 1; k <= 4; ++k) {
    const Eigen::MatrixXd after = at_time(k * spacing), before = at_time(-k * spacing);
    out.first += kFirst[k - 1] / spacing * (after - before);
    out.second += kSecond[k - 1] / (spacing * spacing) * ((after - out.value) + (before - out.value));
  }
  return out;
}

}  // namespace flexarm
