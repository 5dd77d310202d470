#include "joints/kinematics.h"

#include <cassert>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "math/so3.h"

namespace flexarm {

Configuration configuration_of(const State& state) {
  Configuration out;
  out.nodes.reserve(state.nodes.size());
  for (const NodeState& node : state.nodes) out.nodes.push_back(node_pose(node));
  out.released = state.released;
  return out;
}

Configuration initial_configuration(const Model& model) {
  return {model.nodes, model.initial_released};
}

Configuration moved(const Model& model, const DegreesOfFreedom& dof, Configuration from,
                    const Eigen::VectorXd& motion) {
  assert(motion.size() == dof.scalar_count);
  auto& [nodes, released] = from;
  for (int i = 0; i < dof.node_count; ++i) {
    if (dof.slave_joint[i] >= 0) continue;
    nodes[i].position += motion.segment<3>(dof.first[i]);
    nodes[i].orientation = so3::exp_quaternion(Vector3(motion.segment<3>(dof.first[i] + 3))) * nodes[i].orientation;
    nodes[i].rotation = nodes[i].orientation.toRotationMatrix();
  }
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const int variable = dof.variable_of_joint(static_cast<int>(j));
    if (dof.size[variable] == 0) continue;
    const ReleasedVector increment = motion.segment(dof.first[variable], dof.size[variable]);
    released[j] = updated(model.joints[j], released[j], increment);
  }
  place_followers(model, released);
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    nodes[model.joints[j].slave] = slave_pose(model, static_cast<int>(j), nodes, released[j]);
  return from;
}

// Both from the back, since a coordinate that is followed comes behind its followers if it follows another one itself.
void place_followers(const Model& model, std::vector<Released>& released) {
  for (auto follower = model.coordinates.rbegin(); follower != model.coordinates.rend(); ++follower) {
    if (follower->mimicked < 0) continue;
    const Coordinate& leader = model.coordinates[follower->mimicked];
    released[follower->joint].displacement[follower->component] =
        follower->mimic.value(released[leader.joint].displacement[leader.component]);
  }
}

void set_follower_rates(const Model& model, const std::vector<Released>& released, std::vector<ReleasedVector>& rates) {
  for (auto follower = model.coordinates.rbegin(); follower != model.coordinates.rend(); ++follower) {
    if (follower->mimicked < 0) continue;
    const Coordinate& leader = model.coordinates[follower->mimicked];
    rates[follower->joint][follower->component] =
        follower_ratio(model, *follower, released) * rates[leader.joint][leader.component];
  }
}

int multiplier_count(const Model& model) {
  int count = 0;
  for_each_constraint(model, Constraints::WithMultipliers, [&](const auto&, const auto&) { ++count; });
  return count;
}

std::vector<int> multiplier_equations(const Model& model, const DegreesOfFreedom& dof) {
  std::vector<int> equations;
  for_each_multiplier(model, dof, [&](int, int, int equation) { equations.push_back(equation); });
  return equations;
}

Kinematics::Kinematics(const Model& model, const DegreesOfFreedom& dof, Configuration configuration)
    : model_(model),
      dof_(dof),
      configuration_(std::move(configuration)),
      joints_(model.joints.size()),
      slides_(model.joints.size()) {
  const auto& [nodes, released] = configuration_;
  assert(nodes.size() == model.nodes.size() && released.size() >= model.joints.size());
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointMap& joint = model.joints[j];
    if (joint.kind == JointMapKind::Slide)
      slide_variational_maps(model.slide_lines[joint.line], nodes, released[j].displacement[0], Vector6::Zero(),
                             slides_[j]);
    else
      variational_maps(joint, joint_pose(joint, nodes, released[j]), Vector6::Zero(), joints_[j]);
  }
  for (const DegreesOfFreedom::Mimic& mimic : dof.mimics)
    mimics_.push_back(follower_ratio(model, model.coordinates[mimic.coordinate], released));
}

void Kinematics::move_followers(Eigen::Ref<Eigen::MatrixXd> motions) const {
  for (std::size_t i = mimics_.size(); i-- > 0;)  // an entry's master may follow in a later entry
    motions.row(dof_.first[dof_.mimics[i].slave_variable]) =
        mimics_[i] * motions.row(dof_.first[dof_.mimics[i].master_variable]);
}

void Kinematics::move_slave(int j, Eigen::Ref<Eigen::MatrixXd> motions) const {
  const JointMap& joint = model_.joints[j];
  const int released = dof_.first[dof_.variable_of_joint(j)];
  auto slave = motions.middleRows<6>(dof_.first[joint.slave]);
  if (joint.kind == JointMapKind::Slide) {
    const SlideMaps& map = slides_[j];
    slave = map.released_right * motions.row(released);
    for (int k = 0; k < map.count; ++k)
      slave += map.right[k] * motions.middleRows<6>(dof_.first[model_.slide_lines[joint.line].nodes[map.first + k]]);
    return;
  }
  const FoldMaps& map = joints_[j];
  slave = map.right * motions.middleRows(released, map.right.cols());
  if (joint.master < 0) return;
  const auto master = motions.middleRows<6>(dof_.first[joint.master]);
  slave += master;
  slave.topRows<3>() -= so3::hat(map.lever_right) * master.bottomRows<3>();
}

void Kinematics::complete(const Eigen::Ref<Eigen::MatrixXd>& motions) const {
  assert(motions.rows() == dof_.scalar_count);
  move_followers(motions);
  for (int j = 0; j < static_cast<int>(joints_.size()); ++j) move_slave(j, motions);
}

// ---------------------------------------------------------------- constraints of loops

namespace {

/// A row with few entries that are not zero.
class SparseRow {
 public:
  double& operator[](int scalar) { return entries_[scalar]; }
  void add(int first, const Vector6& values) {
    for (int k = 0; k < 6; ++k) entries_[first + k] += values[k];
  }
  /// Returns six entries, and sets them to zero.
  Vector6 take(int first) {
    Vector6 values = Vector6::Zero();
    const auto begin = entries_.lower_bound(first), end = entries_.lower_bound(first + 6);
    for (auto entry = begin; entry != end; ++entry) values[entry->first - first] = entry->second;
    entries_.erase(begin, end);
    return values;
  }
  const std::map<int, double>& entries() const { return entries_; }

 private:
  std::map<int, double> entries_;
};

/// Folds the entries of slaves in a row into those of their masters, from the leaves to the root, and those of
/// followers into the coordinates that they follow. `nodes`: the nodes for which the row has entries.
void fold_row(const Kinematics& kinematics, const std::vector<int>& nodes, SparseRow& row) {
  const Model& model = kinematics.model();
  const DegreesOfFreedom& dof = kinematics.degrees_of_freedom();
  std::set<int> pending;  // joints, which are numbered from the root to the leaves
  const auto add_node = [&](int node) {
    if (node >= 0 && dof.slave_joint[node] >= 0) pending.insert(dof.slave_joint[node]);
  };
  for (const int node : nodes) add_node(node);
  while (!pending.empty()) {
    const int j = *pending.rbegin();
    pending.erase(j);
    const JointMap& joint = model.joints[j];
    const Vector6 g = row.take(dof.first[joint.slave]);
    if (g.isZero(0)) continue;
    const int released = dof.first[dof.variable_of_joint(j)];
    if (joint.kind == JointMapKind::Slide) {
      const SlideMaps& map = kinematics.slide(j);
      row[released] += map.released_right.dot(g);
      for (int k = 0; k < map.count; ++k) {
        const int node = model.slide_lines[joint.line].nodes[map.first + k];
        row.add(dof.first[node], map.right[k].transpose() * g);
        add_node(node);
      }
      continue;
    }
    const FoldMaps& map = kinematics.joint(j);
    for (int k = 0; k < map.right.cols(); ++k) row[released + k] += map.right.col(k).dot(g);
    if (joint.master < 0) continue;
    Vector6 of_master = g;
    of_master.tail<3>() += map.lever_right.cross(g.head<3>());
    row.add(dof.first[joint.master], of_master);
    add_node(joint.master);
  }
  for (std::size_t i = 0; i < dof.mimics.size(); ++i) {
    const int follower = dof.first[dof.mimics[i].slave_variable];
    if (row.entries().count(follower) == 0) continue;
    row[dof.first[dof.mimics[i].master_variable]] += kinematics.mimic(i) * row[follower];
    row[follower] = 0;
  }
}

}  // namespace

Eigen::VectorXd scalar_scales(const Model& model, const DegreesOfFreedom& dof) {
  Eigen::VectorXd scales = Eigen::VectorXd::Ones(dof.scalar_count);
  for (int i = 0; i < dof.node_count; ++i) scales.segment<3>(dof.first[i]).setConstant(model.length_scale);
  for (const Coordinate& coordinate : model.coordinates)
    scales[dof.scalar_of(coordinate)] = coordinate_scale(model, coordinate);
  return scales;
}

ConstraintRows closure_jacobian(const Kinematics& kinematics, Constraints which) {
  const Model& model = kinematics.model();
  const DegreesOfFreedom& dof = kinematics.degrees_of_freedom();
  const Eigen::VectorXd scales = scalar_scales(model, dof);
  std::vector<Eigen::Triplet<double>> entries;
  int rows = 0;
  for_each_constraint(model, which, [&](const LoopClosure& closure, const ClosureConstraint& constraint) {
    const ClosureRows own = closure_rows(closure, constraint, closure_poses(closure, kinematics.nodes()));
    SparseRow row;
    row.add(dof.first[closure.child], own.child);
    if (closure.parent >= 0) row.add(dof.first[closure.parent], own.parent);
    fold_row(kinematics, {closure.child, closure.parent}, row);
    const double unit = 1 / constraint_scale(model, constraint);
    for (const auto& [scalar, value] : row.entries())
      if (value != 0) entries.emplace_back(rows, scalar, unit * value * scales[scalar]);
    ++rows;
  });
  ConstraintRows out(rows, dof.scalar_count);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

ConstraintRows with_columns(ConstraintRows jacobian, const std::vector<bool>& is_kept) {
  jacobian.prune([&](Eigen::Index, Eigen::Index column, double) { return is_kept[column]; });
  return jacobian;
}

std::vector<ConstraintGroup> independent_groups(const ConstraintRows& jacobian) {
  // Union of rows that share a column: each set of rows is named by one of them.
  std::vector<int> above(static_cast<std::size_t>(jacobian.rows())), of_column(jacobian.cols(), -1);
  std::iota(above.begin(), above.end(), 0);
  const auto name_of = [&](int row) {
    while (above[row] != row) row = above[row] = above[above[row]];
    return row;
  };
  using Entry = ConstraintRows::InnerIterator;
  for (int row = 0; row < jacobian.rows(); ++row)
    for (Entry entry(jacobian, row); entry; ++entry) {
      int& first = of_column[entry.col()];
      if (first < 0) first = row;
      above[name_of(row)] = name_of(first);
    }
  std::vector<ConstraintGroup> groups;
  std::vector<int> group_of(above.size(), -1);
  for (int row = 0; row < jacobian.rows(); ++row) {
    int& group = group_of[name_of(row)];
    if (group < 0) {
      group = static_cast<int>(groups.size());
      groups.emplace_back();
    }
    groups[group].rows.push_back(row);
  }
  std::vector<int> place(jacobian.cols(), -1);  // index of each column in its group
  for (ConstraintGroup& group : groups) {
    for (const int row : group.rows)
      for (Entry entry(jacobian, row); entry; ++entry)
        if (int& at = place[entry.col()]; at < 0) {
          at = static_cast<int>(group.columns.size());
          group.columns.push_back(static_cast<int>(entry.col()));
        }
    group.block.setZero(static_cast<Eigen::Index>(group.rows.size()), static_cast<Eigen::Index>(group.columns.size()));
    for (std::size_t i = 0; i < group.rows.size(); ++i)
      for (Entry entry(jacobian, group.rows[i]); entry; ++entry)
        group.block(static_cast<Eigen::Index>(i), place[entry.col()]) = entry.value();
  }
  return groups;
}

}  // namespace flexarm
