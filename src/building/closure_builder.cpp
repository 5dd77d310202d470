#include "building/passes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "building/model_builder.h"
#include "joints/kinematics.h"
#include "math/general_vector.h"
#include "math/least_squares.h"

namespace flexarm {
namespace {

using Kind = ClosureConstraint::Kind;

/// Makes constraints from vectors in world axes, at the start.
class ConstraintMaker {
 public:
  ConstraintMaker(const Pose& parent, const Pose& child, LoopClosure& closure)
      : parent_(parent), child_(child), closure_(closure) {}

  void gap(const Vector3& normal) {
    closure_.constraints.push_back({Kind::Gap, parent_.orientation.conjugate() * normal, Vector3::Zero(), 0});
  }
  /// Keeps the angle between a direction of the child and a normal of the parent constant.
  void direction(const Vector3& of_child, const Vector3& normal) {
    closure_.constraints.push_back({Kind::Direction, parent_.orientation.conjugate() * normal,
                                    child_.orientation.conjugate() * of_child, of_child.dot(normal)});
  }

 private:
  Pose parent_, child_;
  LoopClosure& closure_;
};

/// Adds the constraints of a kind of joint, about its axis (world axes, at the start). Returns false if these are not
/// quadratic.
bool add_constraints(const scene::JointDescription& joint, const Quaternion& frame, ConstraintMaker& maker) {
  using scene::JointKind;
  const Vector3 axis = frame * joint.axis.normalized(), second = frame * joint.axis2.normalized();
  const Vector3 y = axis.unitOrthogonal(), z = axis.cross(y);
  const auto point = [&] { maker.gap(axis), maker.gap(y), maker.gap(z); };
  const auto keep_direction = [&](const Vector3& d) {
    maker.direction(d, d.unitOrthogonal()), maker.direction(d, d.cross(d.unitOrthogonal()));
  };
  const auto parallel_axes = [&] { keep_direction(axis); };
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
    case JointKind::PinSlot:
      return maker.gap(y), maker.gap(z), keep_direction(second), true;
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

Eigen::Index rank_of(const ConstraintRows& jacobian) {
  std::size_t rank = 0;
  for (const ConstraintGroup& group : independent_groups(jacobian))
    rank += independent_rows(group.block, kIndependent).size();
  return static_cast<Eigen::Index>(rank);
}

/// Which scalars can move freely: unknowns that are no multipliers.
std::vector<bool> free_scalars(const DegreesOfFreedom& dof) {
  std::vector<bool> is_free(static_cast<std::size_t>(dof.scalar_count), false);
  for (int scalar = 0; scalar < dof.first[dof.variable_of_closure(0)]; ++scalar)
    is_free[scalar] = dof.equation[scalar] >= 0;
  return is_free;
}

// ---------------------------------------------------------------- dead points

/// Size of the scaled motion for difference quotients, whose error is its square.
constexpr double kStep = 1e-4;
/// Second derivatives of scaled constraints, relative to the square of a motion. Smaller ones may result from rounded
/// numbers in the scene.
constexpr double kCurvature = 1e-5;

/// The part of a general motion that the constraints allow to first order. Its largest component is 1; zero if there is
/// none.
Eigen::VectorXd allowed_motion(const Eigen::MatrixXd& block) {
  const Eigen::VectorXd wanted = general_vector(block.cols());
  const Eigen::VectorXd motion = wanted - smallest_least_squares(block, block * wanted, kIndependent);
  const double largest = motion.lpNorm<Eigen::Infinity>();
  return largest > kIndependent ? Eigen::VectorXd(motion / largest)
                                : Eigen::VectorXd(Eigen::VectorXd::Zero(motion.size()));
}

/// Derivatives of all scaled constraints after the mechanism has moved from its start.
ConstraintRows jacobian_after(const Model& model, const DegreesOfFreedom& dof, const Eigen::VectorXd& motion) {
  const Configuration start = initial_configuration(model);
  return closure_jacobian({model, dof, moved(model, dof, start, motion)}, Constraints::All);
}

/// Second derivatives of all scaled constraints along a scaled motion.
Eigen::VectorXd curvatures(const Model& model, const DegreesOfFreedom& dof, const Eigen::VectorXd& motion) {
  const Eigen::VectorXd way = kStep * scalar_scales(model, dof).cwiseProduct(motion);
  return (jacobian_after(model, dof, way) * motion - jacobian_after(model, dof, -way) * motion) / (2 * kStep);
}

/// Name of the closure that has a row of the Jacobian.
std::string name_of_row(const Model& model, int row) {
  std::string name;
  for_each_constraint(model, Constraints::All, [&](const LoopClosure& closure, const ClosureConstraint&) {
    if (row-- == 0) name = closure.name;
  });
  return name;
}

/// Name of a joint that closes a loop which starts at a dead point; empty if there is none. `jacobian`: of all
/// constraints, with the columns of free scalars. Loops with beams are not judged, since these give way. If constraints
/// depend on each other, y^T B = 0, then motions v that they allow, B v = 0, must have y^T B'(v) v = 0. Otherwise v
/// cannot go on to second order: the loop can go in some of these directions, but not in all. (docs/notes/joints.md
/// 3.1)
std::string loop_at_dead_point(const Model& model, const DegreesOfFreedom& dof, const ConstraintRows& jacobian) {
  const int first_joint = dof.first[dof.variable_of_joint(0)];
  std::vector<ConstraintGroup> groups = independent_groups(jacobian);
  groups.erase(std::remove_if(groups.begin(), groups.end(),
                              [&](const ConstraintGroup& group) {
                                return std::any_of(group.columns.begin(), group.columns.end(),
                                                   [&](int column) { return column < first_joint; });
                              }),
               groups.end());
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(dof.scalar_count);
  for (const ConstraintGroup& group : groups) {
    const Eigen::VectorXd allowed = allowed_motion(group.block);
    for (std::size_t k = 0; k < group.columns.size(); ++k)
      motion[group.columns[k]] = allowed[static_cast<Eigen::Index>(k)];
  }
  if (motion.isZero(0)) return "";
  const Eigen::VectorXd bent = curvatures(model, dof, motion);
  for (const ConstraintGroup& group : groups) {
    Eigen::VectorXd own(static_cast<Eigen::Index>(group.rows.size()));
    for (std::size_t i = 0; i < group.rows.size(); ++i) own[static_cast<Eigen::Index>(i)] = bent[group.rows[i]];
    own -= group.block * smallest_least_squares(group.block, own, kIndependent);
    Eigen::Index worst = 0;
    if (own.cwiseAbs().maxCoeff(&worst) > kCurvature) return name_of_row(model, group.rows[worst]);
  }
  return "";
}

}  // namespace

LoopClosure loop_closure(const ScenePlan& plan, const Mechanism& mechanism, const scene::JointDescription& joint,
                         Attachment parent, Attachment child, const Pose& frame) {
  const std::string where = at(joint.location, "<loop_joint> '" + joint.name + "'");
  if (joint.damping != 0 || joint.friction != 0 || joint.friction_law.coefficient != 0 || joint.limits)
    throw ModelError(
        where +
        "closes a loop of rigid links, so that it has no coordinate and cannot have damping, friction or limits "
        "(type 'continuous' has none): put them on another joint of the loop, or make another joint the "
        "loop joint");
  if (parent.node == child.node)
    throw ModelError(where +
                     (joint.parent == joint.child && plan.meshes[plan.links[joint.child]]
                          ? "both places are the same section of link '" + joint.child +
                                "': connect two different places of its line; for a ring, let the line end where "
                                "it begins (within 1e-6 of its length)"
                          : std::string("both places belong to the same rigid body")));
  LoopClosure closure;
  closure.is_reversed = child.node < 0;
  if (closure.is_reversed) std::swap(parent, child);
  closure.name = joint.name;
  closure.parent = parent.node;
  closure.child = child.node;
  closure.parent_arm = (mechanism.pose_of(parent.node).inverse() * frame).position;
  closure.child_arm = (mechanism.pose_of(child.node).inverse() * frame).position;
  ConstraintMaker maker(mechanism.pose_of(parent.node), mechanism.pose_of(child.node), closure);
  if (!add_constraints(joint, frame.orientation, maker))
    throw ModelError(where +
                     "a joint of this kind cannot close a loop of rigid links: make another joint of the loop the loop "
                     "joint, or attach it to the free end of a flexible link");
  return closure;
}

SolvableMechanism choose_constraints(const ScenePlan& plan, DrivenMechanism mechanism) {
  Model& model = mechanism.model;
  if (model.closures.empty()) return {std::move(mechanism)};
  const DegreesOfFreedom dof(model);
  std::vector<bool> is_free = free_scalars(dof);
  const Kinematics kinematics(model, dof, initial_configuration(model));
  const ConstraintRows jacobian = with_columns(closure_jacobian(kinematics, Constraints::All), is_free);
  std::vector<bool> is_kept(static_cast<std::size_t>(jacobian.rows()), false);
  for (const ConstraintGroup& group : independent_groups(jacobian))
    for (const Eigen::Index row : independent_rows(group.block, kIndependent)) is_kept[group.rows[row]] = true;
  const auto rank = std::count(is_kept.begin(), is_kept.end(), true);
  const bool is_driven = std::any_of(model.coordinates.begin(), model.coordinates.end(),
                                     [](const Coordinate& coordinate) { return coordinate.motion >= 0; });
  if (rank == std::count(is_free.begin(), is_free.end(), true) && !is_driven)
    throw ModelError(at_loop_joint(plan.scene, model.closures.front().name) +
                     "with this and other loop joints the mechanism cannot move: there is nothing to compute");
  for (const Coordinate& coordinate : model.coordinates)
    if (coordinate.sticks) is_free[dof.scalar_of(coordinate)] = false;
  if (rank_of(with_columns(jacobian, is_free)) < rank)
    throw ModelError(
        at_loop_joint(plan.scene, model.closures.front().name) +
        "in the rigid loop that it closes, more joints may stick (<friction law=\"coulomb\">) than the loop "
        "has degrees of freedom, so that their friction forces would be undetermined: give some of them "
        "the law 'smooth'");
  if (const std::string loop = loop_at_dead_point(model, dof, jacobian); !loop.empty())
    throw ModelError(at_loop_joint(plan.scene, loop) +
                     "its loop starts at a dead point, from which it can move in more than one way: start it a little "
                     "away from there, by <initial>");
  std::size_t row = 0;
  for (LoopClosure& closure : model.closures) {
    std::vector<ClosureConstraint> all;
    std::swap(all, closure.constraints);
    for (const ClosureConstraint& constraint : all)
      (is_kept[row++] ? closure.constraints : closure.implied).push_back(constraint);
  }
  return {std::move(mechanism)};
}

}  // namespace flexarm
