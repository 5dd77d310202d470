#include "joints/closure_jacobian.h"

#include <map>
#include <numeric>
#include <set>

#include "joints/closure_maps.h"
#include "joints/joint_kinematics.h"

namespace flexarm {
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

/// Folds the entries of slaves in a row into those of their masters, from the leaves to the root.
class RowFolder {
 public:
  RowFolder(const Model& model, const DegreesOfFreedom& dof)
      : model_(model), dof_(dof), maps_(model.joints.size()), velocities_(model.nodes.size(), Vector6::Zero()) {
    for (std::size_t j = 0; j < model.joints.size(); ++j) {
      const JointMap& joint = model.joints[j];
      if (joint.kind != JointMapKind::Slide)
        variational_maps(joint, joint_pose(joint, model.nodes, model.initial_released[j]), Vector6::Zero(), maps_[j]);
    }
  }

  /// `nodes`: the nodes for which the row has entries.
  void fold(const std::vector<int>& nodes, SparseRow& row) {
    std::set<int> pending;  // joints, which are numbered from the root to the leaves
    const auto add_node = [&](int node) {
      if (node >= 0 && dof_.slave_joint[node] >= 0) pending.insert(dof_.slave_joint[node]);
    };
    for (const int node : nodes) add_node(node);
    while (!pending.empty()) {
      const int j = *pending.rbegin();
      pending.erase(j);
      const JointMap& joint = model_.joints[j];
      const Vector6 g = row.take(dof_.first[joint.slave]);
      if (g.isZero(0)) continue;
      const int released = dof_.first[dof_.variable_of_joint(j)];
      if (joint.kind == JointMapKind::Slide) {
        fold_slide(j, g, released, row);
        for (const int node : model_.slide_lines[joint.line].nodes) add_node(node);
        continue;
      }
      const FoldMaps& map = maps_[j];
      for (int k = 0; k < map.right.cols(); ++k) row[released + k] += map.right.col(k).dot(g);
      if (joint.master < 0) continue;
      Vector6 of_master = g;
      of_master.tail<3>() += map.lever_right.cross(g.head<3>());
      row.add(dof_.first[joint.master], of_master);
      add_node(joint.master);
    }
    for (const DegreesOfFreedom::Mimic& mimic : dof_.mimics) {
      const Coordinate& following = model_.coordinates[mimic.coordinate];
      const int master = model_.coordinates[following.mimicked].joint;
      const int slave = dof_.first[mimic.slave_variable];
      if (row.entries().count(slave) == 0) continue;
      row[dof_.first[mimic.master_variable]] +=
          following.mimic.derivative(model_.initial_released[master].displacement[0]) * row[slave];
      row[slave] = 0;
    }
  }

 private:
  void fold_slide(int j, const Vector6& g, int released, SparseRow& row) {
    // Give the line's nodes unit velocities one by one, since a slide has no other map of velocities.
    const SlideLine& line = model_.slide_lines[model_.joints[j].line];
    for (const int node : line.nodes)
      for (int k = 0; k < 6; ++k) {
        velocities_[node] = Vector6::Unit(k);
        const SlaveVelocity slave = slave_velocity(model_, j, model_.nodes, model_.initial_released[j], velocities_);
        row[dof_.first[node] + k] += slave.carried.dot(g);
        row[released] = slave.columns.col(0).dot(g);
        velocities_[node].setZero();
      }
  }

  const Model& model_;
  const DegreesOfFreedom& dof_;
  std::vector<FoldMaps> maps_;
  std::vector<Vector6> velocities_;  // per node; zero between calls
};

template <class Visit>
void for_each_constraint(const Model& model, const Visit& visit) {
  for (const LoopClosure& closure : model.closures)
    for (const auto* list : {&closure.constraints, &closure.implied})
      for (const ClosureConstraint& constraint : *list) visit(closure, constraint);
}

/// Scale of each row: the length scale for a gap, 1 for a direction.
Eigen::VectorXd constraint_scales(const Model& model) {
  std::vector<double> scales;
  for_each_constraint(model, [&](const LoopClosure&, const ClosureConstraint& constraint) {
    scales.push_back(constraint.kind == ClosureConstraint::Kind::Gap ? model.length_scale : 1.0);
  });
  return Eigen::VectorXd::Map(scales.data(), static_cast<Eigen::Index>(scales.size()));
}

}  // namespace

Eigen::VectorXd scalar_scales(const Model& model, const DegreesOfFreedom& dof) {
  Eigen::VectorXd scales = Eigen::VectorXd::Ones(dof.scalar_count);
  for (int i = 0; i < dof.node_count; ++i) scales.segment<3>(dof.first[i]).setConstant(model.length_scale);
  for (const Coordinate& coordinate : model.coordinates)
    if (!is_rotation(model, coordinate)) scales[dof.scalar_of(coordinate)] = model.length_scale;
  return scales;
}

ConstraintRows closure_jacobian(const Model& model, const DegreesOfFreedom& dof) {
  RowFolder folder(model, dof);
  std::vector<Eigen::Triplet<double>> entries;
  int rows = 0;
  for_each_constraint(model, [&](const LoopClosure& closure, const ClosureConstraint& constraint) {
    const NodePose parent = closure.parent < 0 ? NodePose() : model.nodes[closure.parent];
    const ClosureRows own = closure_rows(closure, constraint, {parent, model.nodes[closure.child]});
    SparseRow row;
    row.add(dof.first[closure.child], own.child);
    if (closure.parent >= 0) row.add(dof.first[closure.parent], own.parent);
    folder.fold({closure.child, closure.parent}, row);
    for (const auto& [scalar, value] : row.entries())
      if (value != 0) entries.emplace_back(rows, scalar, value);
    ++rows;
  });
  ConstraintRows out(rows, dof.scalar_count);
  out.setFromTriplets(entries.begin(), entries.end());
  return constraint_scales(model).cwiseInverse().asDiagonal() * out * scalar_scales(model, dof).asDiagonal();
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
