// Loops that no free node of a beam can close: constraints with multipliers. (joints.md 3)
#include "closure_builder.h"

#include "flexarm/joints/joint_kinematics.h"
#include "flexarm/joints/loop_closure.h"
#include "mechanism_builder.h"

namespace flexarm {
namespace {

using Kind = ClosureConstraint::Kind;

/// Scaled constraints are independent if a pivot is larger than this part of the largest one.
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

/// One row, from the leaves to the root.
class RowFolder {
 public:
  RowFolder(const Model& model, const DegreesOfFreedom& dof) : model_(model), dof_(dof), maps_(model.joints.size()) {
    for (std::size_t j = 0; j < model.joints.size(); ++j) {
      const JointMap& joint = model.joints[j];
      if (joint.kind != JointMapKind::Slide)
        variational_maps(joint, joint.master < 0 ? NodePose() : model.nodes[joint.master], model.initial_released[j],
                         Vector6::Zero(), maps_[j]);
    }
  }

  void fold(Eigen::Ref<Eigen::RowVectorXd> row) const {
    for (std::size_t j = model_.joints.size(); j-- > 0;) {
      const JointMap& joint = model_.joints[j];
      Eigen::Ref<Eigen::RowVectorXd> slave = row.segment(dof_.first[joint.slave], 6);
      const Vector6 g = slave.transpose();
      slave.setZero();
      if (g.isZero(0)) continue;
      const int released = dof_.first[dof_.variable_of_joint(static_cast<int>(j))];
      if (joint.kind == JointMapKind::Slide) {
        fold_slide(static_cast<int>(j), g, released, row);
        continue;
      }
      const FoldMaps& map = maps_[j];
      for (int k = 0; k < map.right.cols(); ++k) row[released + k] += map.right.col(k).dot(g);
      if (joint.master < 0) continue;
      Eigen::Ref<Eigen::RowVectorXd> master = row.segment(dof_.first[joint.master], 6);
      master += g.transpose();
      master.tail<3>() += map.lever_right.cross(g.head<3>()).transpose();
    }
    for (const DegreesOfFreedom::Mimic& mimic : dof_.mimics) {
      const Coordinate& following = model_.coordinates[mimic.coordinate];
      const int master = model_.coordinates[following.mimicked].joint;
      double& entry = row[dof_.first[mimic.slave_variable]];
      row[dof_.first[mimic.master_variable]] +=
          following.mimic.derivative(model_.initial_released[master].displacement[0]) * entry;
      entry = 0;
    }
  }

 private:
  void fold_slide(int j, const Vector6& g, int released, Eigen::Ref<Eigen::RowVectorXd> row) const {
    // Velocities of the line's nodes one by one: a slide has no other maps of velocity.
    const SlideLine& line = model_.slide_lines[model_.joints[j].line];
    std::vector<Vector6> velocities(model_.nodes.size(), Vector6::Zero());
    for (const int node : line.nodes)
      for (int k = 0; k < 6; ++k) {
        velocities[node] = Vector6::Unit(k);
        const SlaveVelocity slave = slave_velocity(model_, j, model_.nodes, model_.initial_released[j], velocities);
        row[dof_.first[node] + k] += slave.carried.dot(g);
        row[released] = slave.columns.col(0).dot(g);
        velocities[node].setZero();
      }
  }

  const Model& model_;
  const DegreesOfFreedom& dof_;
  std::vector<FoldMaps> maps_;
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

Eigen::MatrixXd closure_jacobian(const Model& model, const DegreesOfFreedom& dof) {
  const RowFolder folder(model, dof);
  std::vector<Eigen::RowVectorXd> rows;
  for_each_constraint(model, [&](const LoopClosure& closure, const ClosureConstraint& constraint) {
    const NodePose parent = closure.parent < 0 ? NodePose() : model.nodes[closure.parent];
    const ClosureRows own = closure_rows(closure, constraint, {parent, model.nodes[closure.child]});
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(dof.scalar_count);
    row.segment<6>(dof.first[closure.child]) += own.child.transpose();
    if (closure.parent >= 0) row.segment<6>(dof.first[closure.parent]) += own.parent.transpose();
    folder.fold(row);
    rows.push_back(row);
  });
  Eigen::MatrixXd out(static_cast<Eigen::Index>(rows.size()), dof.scalar_count);
  for (std::size_t i = 0; i < rows.size(); ++i) out.row(static_cast<Eigen::Index>(i)) = rows[i];
  return out;
}

void MechanismBuilder::add_closure(const scene::JointDescription& joint, Attachment parent, Attachment child,
                                   const Pose& frame) {
  const std::string where = at(joint.location, "<loop_joint> '" + joint.name + "'");
  if (joint.damping != 0 || joint.friction != 0 || joint.friction_law.coefficient != 0 || joint.limits)
    throw ModelError(where +
                     "closes a loop of rigid links, where it has no coordinate that could have damping, friction or "
                     "limits (type 'continuous' has none): put them on another joint of the loop, or cut it there");
  if (parent.node == child.node) throw ModelError(where + "both places belong to the same rigid body");
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
  Eigen::MatrixXd jacobian =
      constraint_scales(model).cwiseInverse().asDiagonal() * closure_jacobian(model, dof) * scales.asDiagonal();
  const int multipliers = dof.first[dof.variable_of_closure(0)];
  int unknowns = 0;
  for (int scalar = 0; scalar < multipliers; ++scalar) {
    if (dof.equation[scalar] < 0)
      jacobian.col(scalar).setZero();
    else
      ++unknowns;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr = factorised(jacobian);
  const Eigen::Index rank = rank_of(qr);
  bool is_driven = false;
  for (const Coordinate& coordinate : model.coordinates) is_driven = is_driven || coordinate.motion >= 0;
  if (rank == unknowns && !is_driven)
    throw ModelError(scene_.file + ": the loop joints leave the mechanism no motion ('" + model.closures.front().name +
                     "' and others): nothing is left to compute");
  Eigen::MatrixXd without_sticking = jacobian;
  for (const Coordinate& coordinate : model.coordinates)
    if (coordinate.sticks)
      without_sticking.col(dof.first[dof.variable_of_joint(coordinate.joint)] + coordinate.component).setZero();
  if (rank_of(factorised(without_sticking)) < rank)
    throw ModelError(scene_.file + ": more joints of the rigid loop that '" + model.closures.front().name +
                     "' closes may stick (<friction law=\"coulomb\">) than it has freedoms, and the force that holds "
                     "each would be undetermined: give some of them the law 'smooth'");
  std::vector<bool> is_kept(static_cast<std::size_t>(jacobian.rows()), false);
  for (Eigen::Index k = 0; k < rank; ++k) is_kept[qr.colsPermutation().indices()[k]] = true;
  std::size_t row = 0;
  for (LoopClosure& closure : model.closures) {
    std::vector<ClosureConstraint> all;
    std::swap(all, closure.constraints);
    for (const ClosureConstraint& constraint : all)
      (is_kept[row++] ? closure.constraints : closure.implied).push_back(constraint);
  }
}

}  // namespace flexarm
