#pragma once
/// Kinematics of a mechanism in one configuration: its joints, the coordinates that follow others, and its loops.

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "joints/closure_maps.h"
#include "joints/joint_kinematics.h"
#include "model/degrees_of_freedom.h"
#include "model/state.h"

namespace flexarm {

/// Poses of all nodes, slaves included, and values of all released coordinates.
struct Configuration {
  std::vector<NodePose> nodes;
  std::vector<Released> released;  ///< per joint
};
Configuration configuration_of(const State& state);
Configuration initial_configuration(const Model& model);
/// Returns the configuration after a motion with an entry for each scalar: {displacement, rotation vector} of nodes
/// along world axes, and increments of released coordinates. Slaves and followers are placed anew; their entries do not
/// count.
Configuration moved(const Model& model, const DegreesOfFreedom& dof, Configuration from, const Eigen::VectorXd& motion);

// ---------------------------------------------------------------- coordinates that follow others

/// Returns the rate of a coordinate that follows another one, per rate of that one.
inline double follower_ratio(const Model& model, const Coordinate& follower, const std::vector<Released>& released) {
  return follower.mimic.derivative(released[model.coordinates[follower.mimicked].joint].displacement[0]);
}
/// Sets the positions of all coordinates that follow others.
void place_followers(const Model& model, std::vector<Released>& released);
/// Sets their rates. `rates`: per joint.
void set_follower_rates(const Model& model, const std::vector<Released>& released, std::vector<ReleasedVector>& rates);

// ---------------------------------------------------------------- closures of loops

inline ClosurePoses closure_poses(const LoopClosure& closure, const std::vector<NodePose>& nodes) {
  return {closure.parent < 0 ? kWorld : nodes[closure.parent], nodes[closure.child]};
}
/// Returns the unit of a constraint's value: the model's length scale for a gap [m], 1 for a direction.
inline double constraint_scale(const Model& model, const ClosureConstraint& constraint) {
  return constraint.kind == ClosureConstraint::Kind::Gap ? model.length_scale : 1.0;
}
/// Returns the unit of a coordinate, so that all of them have the same size.
inline double coordinate_scale(const Model& model, const Coordinate& coordinate) {
  return is_rotation(model, coordinate) ? 1.0 : model.length_scale;
}
/// Only the constraints with multipliers, or those that they imply as well, closure by closure.
enum class Constraints { WithMultipliers, All };
/// Calls visit(closure, constraint) for each of them. Those with multipliers are in the order of these.
template <class Visit>
void for_each_constraint(const Model& model, Constraints which, const Visit& visit) {
  for (const LoopClosure& closure : model.closures) {
    for (const ClosureConstraint& constraint : closure.constraints) visit(closure, constraint);
    if (which == Constraints::WithMultipliers) continue;
    for (const ClosureConstraint& constraint : closure.implied) visit(closure, constraint);
  }
}
/// Calls visit(closure, constraint, equation) for each multiplier, in the order of their equations. These are the last
/// ones of all unknowns, and as many as the constraints with multipliers. `closure`: its index. `constraint`: its index
/// in the closure.
template <class Visit>
void for_each_multiplier(const Model& model, const DegreesOfFreedom& dof, const Visit& visit) {
  for (int k = 0; k < static_cast<int>(model.closures.size()); ++k) {
    const int first = dof.first[dof.variable_of_closure(k)];
    for (int i = 0; i < static_cast<int>(model.closures[k].constraints.size()); ++i)
      visit(k, i, dof.equation[first + i]);
  }
}
int multiplier_count(const Model& model);
std::vector<int> multiplier_equations(const Model& model, const DegreesOfFreedom& dof);

// ---------------------------------------------------------------- all joints

/// The maps from independent to dependent motions of a model, in one configuration. Allocates memory; a step has maps
/// over its length instead (StepConfiguration).
class Kinematics {
 public:
  /// `model` and `dof` must outlive this object.
  Kinematics(const Model& model, const DegreesOfFreedom& dof, Configuration configuration);

  const Model& model() const { return model_; }
  const DegreesOfFreedom& degrees_of_freedom() const { return dof_; }
  const std::vector<NodePose>& nodes() const { return configuration_.nodes; }

  /// Maps for a zero residual: of a joint that is no slide, and of one that is.
  const FoldMaps& joint(int joint) const { return joints_[joint]; }
  const SlideMaps& slide(int joint) const { return slides_[joint]; }
  /// The follower_ratio() of an entry of DegreesOfFreedom::mimics.
  double mimic(std::size_t entry) const { return mimics_[entry]; }

  // Small motions have a row for each scalar of `dof`: {displacement [m], spin [rad]} of nodes along world axes, and
  // released coordinates. Each column is a motion.
  /// Sets the rows of coordinates that follow others.
  void move_followers(Eigen::Ref<Eigen::MatrixXd> motions) const;
  /// Sets the rows of a joint's slave, from those of its masters and its coordinates.
  void move_slave(int joint, Eigen::Ref<Eigen::MatrixXd> motions) const;
  /// Sets the rows of all followers and all slaves, in the numbers to which `motions` refers.
  void complete(const Eigen::Ref<Eigen::MatrixXd>& motions) const;

 private:
  const Model& model_;
  const DegreesOfFreedom& dof_;
  Configuration configuration_;
  std::vector<FoldMaps> joints_;
  std::vector<SlideMaps> slides_;
  std::vector<double> mimics_;
};

// ---------------------------------------------------------------- constraints of loops

/// One row for each constraint.
using ConstraintRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The rule of rank for loops: rows or columns of scaled constraints are independent if their pivots are larger than
/// this part of the largest one. Numbers of a scene are rounded by as much, relative to its size and to 1 rad, and so
/// are the derivatives of constraints at the start. Later these are exact to 1e-16; then what follows through such a
/// pivot still has ten digits.
constexpr double kIndependent = 1e-6;

/// For each scalar of nodes and joints: the model's length scale if it is a displacement, 1 if it is a rotation.
Eigen::VectorXd scalar_scales(const Model& model, const DegreesOfFreedom& dof);

/// Derivatives of the constraints' values by the scalars of `dof`. Values and scalars are divided by their scales.
/// Columns of slaves and of following coordinates are folded into those of their masters, and are then zero.
ConstraintRows closure_jacobian(const Kinematics& kinematics, Constraints which);

/// Sets the other columns to zero.
ConstraintRows with_columns(ConstraintRows jacobian, const std::vector<bool>& is_kept);

/// Rows that share columns, directly or through other rows, and their entries that are not zero. A mechanism of many
/// loops has many small groups, unless its loops are connected.
struct ConstraintGroup {
  std::vector<int> rows, columns;
  Eigen::MatrixXd block;
};
std::vector<ConstraintGroup> independent_groups(const ConstraintRows& jacobian);

}  // namespace flexarm
