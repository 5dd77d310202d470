#include "building/dead_points.h"

#include <algorithm>
#include <cmath>

#include "joints/joint_kinematics.h"
#include "math/general_vector.h"
#include "math/least_squares.h"

namespace flexarm {
namespace {

/// Scaled motion by which derivatives are found, whose error is its square.
constexpr double kStep = 1e-4;
/// Second derivatives of scaled constraints beside the square of a motion: less is what the scene's rounded numbers
/// leave.
constexpr double kCurvature = 1e-5;

/// What of a general motion the constraints allow, to first order; its largest component is 1.
Eigen::VectorXd allowed_motion(const Eigen::MatrixXd& block) {
  const Eigen::VectorXd wanted = general_vector(block.cols());
  const Eigen::VectorXd motion = wanted - smallest_least_squares(block, block * wanted, kIndependent);
  const double largest = motion.lpNorm<Eigen::Infinity>();
  return largest > kIndependent ? Eigen::VectorXd(motion / largest)
                                : Eigen::VectorXd(Eigen::VectorXd::Zero(motion.size()));
}

/// With joints moved by the scaled `motion` of the scalars.
Model moved(Model model, const DegreesOfFreedom& dof, const Eigen::VectorXd& motion) {
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const int variable = dof.variable_of_joint(static_cast<int>(j));
    if (dof.size[variable] == 0) continue;
    const ReleasedVector increment = motion.segment(dof.first[variable], dof.size[variable]);
    model.initial_released[j] = updated(model.joints[j], model.initial_released[j], increment);
  }
  for (const Coordinate& coordinate : model.coordinates)
    if (coordinate.mimicked >= 0)
      model.initial_released[coordinate.joint].displacement[0] =
          coordinate.mimic.value(model.initial_released[model.coordinates[coordinate.mimicked].joint].displacement[0]);
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    model.nodes[model.joints[j].slave] = slave_pose(model, static_cast<int>(j), model.nodes, model.initial_released[j]);
  return model;
}

/// Second derivatives of all constraints along a motion.
Eigen::VectorXd curvatures(const Model& model, const DegreesOfFreedom& dof, const Eigen::VectorXd& motion) {
  const Eigen::VectorXd way = kStep * scalar_scales(model, dof).cwiseProduct(motion);
  return (closure_jacobian(moved(model, dof, way), dof) * motion -
          closure_jacobian(moved(model, dof, -way), dof) * motion) /
         (2 * kStep);
}

/// Of the closure that has a row of the Jacobian.
std::string name_of_row(const Model& model, int row) {
  for (const LoopClosure& closure : model.closures) {
    row -= static_cast<int>(closure.constraints.size() + closure.implied.size());
    if (row < 0) return closure.name;
  }
  return "";
}

}  // namespace

// Where constraints depend on each other, y^T B = 0, motions of their kernel must not bend what they depend by,
// y^T B'(v) v = 0, or they have no second order: the loop goes some of these ways, but not all.
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

}  // namespace flexarm
