// Loops that no free node of a beam can close: constraints with multipliers. (joints.md 3)
#include "closure_builder.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "joints/joint_kinematics.h"
#include "joints/closure_maps.h"
#include "mechanism_builder.h"

namespace flexarm {
namespace {

using Kind = ClosureConstraint::Kind;

/// Scaled constraints are independent if a pivot is larger than this part of the largest one of its group.
constexpr double kIndependent = 1e-6;

/// Makes constraints from vectors in the world, at the start.
class ConstraintMaker {
 public:
  ConstraintMaker(const Pose& parent, const Pose& child, LoopClosure& closure)
      : parent_(parent), child_(child), closure_(closure) {}

  void gap(const Vector3& normal) {
    closure_.constraints.push_back({Kind::Gap, parent_.orientation.conjugate() * normal, Vector3::Zero(), 0});
  }
  /// The angle between a direction of the child and a normal of the parent stays as it is.
  void direction(const Vector3& of_child, const Vector3& normal) {
    closure_.constraints.push_back({Kind::Direction, parent_.orientation.conjugate() * normal,
                                    child_.orientation.conjugate() * of_child, of_child.dot(normal)});
  }

 private:
  Pose parent_, child_;
  LoopClosure& closure_;
};

/// What a kind of joint holds, about its axis (world, at the start); false where that is not quadratic.
bool add_constraints(const scene::JointDescription& joint, const Quaternion& frame, ConstraintMaker& maker) {
  using scene::JointKind;
  const Vector3 axis = frame * joint.axis.normalized(), second = frame * joint.axis2.normalized();
  const Vector3 y = axis.unitOrthogonal(), z = axis.cross(y);
  const auto point = [&] { maker.gap(axis), maker.gap(y), maker.gap(z); };
  const auto parallel_axes = [&] { maker.direction(axis, y), maker.direction(axis, z); };
  const auto no_turn = [&] { parallel_axes(), maker.direction(y, z); };
  switch (joint.kind) {
    case JointKind::Fixed:
      return point(), no_turn(), true;
    case JointKind::Revolute:
    case JointKind::Continuous:
      return point(), parallel_axes(), true;
    case JointKind::Prismatic:
      return maker.gap(y), maker.gap(z), no_turn(), true;
    case JointKind::Cylindrical:
      return maker.gap(y), maker.gap(z), parallel_axes(), true;
    case JointKind::Planar:
      return maker.gap(axis), parallel_axes(), true;
    case JointKind::Spherical:
      return point(), true;
    case JointKind::Universal:
      return point(), maker.direction(second, axis), true;
    default:
      return false;
  }
}

/// A row that is zero nearly everywhere.
class SparseRow {
 public:
  double& operator[](int scalar) { return entries_[scalar]; }
  void add(int first, const Vector6& values) {
    for (int k = 0; k < 6; ++k) entries_[first + k] += values[k];
  }
  /// Six entries, which become zero.
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

/// One row, from the leaves to the root.
class RowFolder {
 public:
  RowFolder(const Model& model, const DegreesOfFreedom& dof)
      : model_(model), dof_(dof), maps_(model.joints.size()), velocities_(model.nodes.size(), Vector6::Zero()) {
    for (std::size_t j = 0; j < model.joints.size(); ++j) {
      const JointMap& joint = model.joints[j];
      if (joint.kind != JointMapKind::Slide)
        variational_maps(joint, joint.master < 0 ? NodePose() : model.nodes[joint.master], model.initial_released[j],
                         Vector6::Zero(), maps_[j]);
    }
  }

  /// `nodes`: those that the row has entries of.
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
    // Velocities of the line's nodes one by one: a slide has no other maps of velocity.
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

/// Pivoting takes independent constraints first: the columns of the transpose.
Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factorised(const Eigen::MatrixXd& jacobian) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(kIndependent);
  qr.compute(jacobian.transpose());
  return qr;
}

Eigen::Index rank_of(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr) {
  return qr.maxPivot() > kIndependent ? qr.rank() : 0;
}

Eigen::Index rank_of(const ConstraintRows& jacobian) {
  Eigen::Index rank = 0;
  for (const ConstraintGroup& group : independent_groups(jacobian)) rank += rank_of(factorised(group.block));
  return rank;
}

/// Without the columns for which is_kept(column) is false.
template <class IsKept>
ConstraintRows with_columns(ConstraintRows jacobian, const IsKept& is_kept) {
  jacobian.prune([&](Eigen::Index, Eigen::Index column, double) { return is_kept(static_cast<int>(column)); });
  return jacobian;
}

template <class Visit>
void for_each_constraint(const Model& model, const Visit& visit) {
  for (const LoopClosure& closure : model.closures)
    for (const auto* list : {&closure.constraints, &closure.implied})
      for (const ClosureConstraint& constraint : *list) visit(closure, constraint);
}

}  // namespace

Eigen::VectorXd scalar_scales(const Model& model, const DegreesOfFreedom& dof) {
  Eigen::VectorXd scales = Eigen::VectorXd::Ones(dof.scalar_count);
  for (int i = 0; i < dof.node_count; ++i) scales.segment<3>(dof.first[i]).setConstant(model.length_scale);
  for (const Coordinate& coordinate : model.coordinates)
    if (!coordinate.is_angle && model.joints[coordinate.joint].rotation.isZero(0))
      scales[dof.first[dof.variable_of_joint(coordinate.joint)] + coordinate.component] = model.length_scale;
  return scales;
}

Eigen::VectorXd constraint_scales(const Model& model) {
  std::vector<double> scales;
  for_each_constraint(model, [&](const LoopClosure&, const ClosureConstraint& constraint) {
    scales.push_back(constraint.kind == Kind::Gap ? model.length_scale : 1.0);
  });
  return Eigen::VectorXd::Map(scales.data(), static_cast<Eigen::Index>(scales.size()));
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
  return out;
}

std::vector<ConstraintGroup> independent_groups(const ConstraintRows& jacobian) {
  // Sets of rows, each named by one of them (union by column).
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
  std::vector<int> place(jacobian.cols(), -1);  // of a column in its group
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

void MechanismBuilder::add_closure(const scene::JointDescription& joint, Attachment parent, Attachment child,
                                   const Pose& frame) {
  const std::string where = at(joint.location, "<loop_joint> '" + joint.name + "'");
  if (joint.damping != 0 || joint.friction != 0 || joint.friction_law.coefficient != 0 || joint.limits)
    throw ModelError(where +
                     "closes a loop of rigid links, where it has no coordinate that could have damping, friction or "
                     "limits (type 'continuous' has none): put them on another joint of the loop, or cut it there");
  if (parent.node == child.node)
    throw ModelError(where + (joint.parent == joint.child && meshes[link_index(joint.child)]
                                  ? "both places are the same section of link '" + joint.child +
                                        "': join two places of its line, or let the line end where it begins (within "
                                        "1e-6 of its length) for a ring"
                                  : std::string("both places belong to the same rigid body")));
  if (child.node < 0) std::swap(parent, child);
  LoopClosure closure;
  closure.name = joint.name;
  closure.parent = parent.node;
  closure.child = child.node;
  closure.parent_arm = (pose_of(parent.node).inverse() * frame).position;
  closure.child_arm = (pose_of(child.node).inverse() * frame).position;
  ConstraintMaker maker(pose_of(parent.node), pose_of(child.node), closure);
  if (!add_constraints(joint, frame.orientation, maker))
    throw ModelError(where +
                     "a joint of this kind cannot close a loop of rigid links: cut the loop at another joint, or let a "
                     "flexible link's free end be one of the joined places");
  model.closures.push_back(closure);
}

void MechanismBuilder::choose_constraints() {
  if (model.closures.empty()) return;
  model.length_scale = extent();
  const DegreesOfFreedom dof(model);
  const Eigen::VectorXd scales = scalar_scales(model, dof);
  const ConstraintRows all_columns =
      constraint_scales(model).cwiseInverse().asDiagonal() * closure_jacobian(model, dof) * scales.asDiagonal();
  const ConstraintRows jacobian = with_columns(all_columns, [&](int scalar) { return dof.equation[scalar] >= 0; });
  const auto multipliers = dof.equation.begin() + dof.first[dof.variable_of_closure(0)];
  const auto unknowns = std::count_if(dof.equation.begin(), multipliers, [](int equation) { return equation >= 0; });
  std::vector<bool> is_kept(static_cast<std::size_t>(jacobian.rows()), false);
  Eigen::Index rank = 0;
  for (const ConstraintGroup& group : independent_groups(jacobian)) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr = factorised(group.block);
    const Eigen::Index independent = rank_of(qr);
    for (Eigen::Index k = 0; k < independent; ++k) is_kept[group.rows[qr.colsPermutation().indices()[k]]] = true;
    rank += independent;
  }
  bool is_driven = false;
  for (const Coordinate& coordinate : model.coordinates) is_driven = is_driven || coordinate.motion >= 0;
  if (rank == unknowns && !is_driven)
    throw ModelError(scene_.file + ": the loop joints leave the mechanism no motion ('" + model.closures.front().name +
                     "' and others): nothing is left to compute");
  std::vector<bool> sticks(static_cast<std::size_t>(dof.scalar_count), false);
  for (const Coordinate& coordinate : model.coordinates)
    if (coordinate.sticks) sticks[dof.first[dof.variable_of_joint(coordinate.joint)] + coordinate.component] = true;
  if (rank_of(with_columns(jacobian, [&](int scalar) { return !sticks[scalar]; })) < rank)
    throw ModelError(scene_.file + ": more joints of the rigid loop that '" + model.closures.front().name +
                     "' closes may stick (<friction law=\"coulomb\">) than it has freedoms, and the force that holds "
                     "each would be undetermined: give some of them the law 'smooth'");
  std::size_t row = 0;
  for (LoopClosure& closure : model.closures) {
    std::vector<ClosureConstraint> all;
    std::swap(all, closure.constraints);
    for (const ClosureConstraint& constraint : all)
      (is_kept[row++] ? closure.constraints : closure.implied).push_back(constraint);
  }
}

}  // namespace flexarm
