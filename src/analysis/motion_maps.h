#pragma once
/// Maps from the coordinates of a mechanism to the motion of all its parts, and their change along a motion.
/// (docs/notes/linearisation.md 1)

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "model/degrees_of_freedom.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Where all nodes and coordinates stand.
struct MechanismPose {
  std::vector<NodePose> nodes;     ///< slaves included
  std::vector<Released> released;  ///< per joint
};
MechanismPose pose_of(const State& state);
/// At rest, if only poses matter.
State state_at(const MechanismPose& pose);

/// First and second derivatives of the coordinates along a motion, one entry per column of MotionMaps.
struct CoordinateRates {
  Eigen::VectorXd first, second;
};

/// The variations of all scalars, {displacement [m], spin [rad]} of every node and the released coordinates [m, rad],
/// by coordinates of the mechanism: one for each unknown that is no multiplier. Displacements of nodes are along world
/// axes, spins along the node's own. The coordinates are those of joints, and {displacement, spin} of nodes as seen
/// from the node that carries their link, along its axes: so what is steady in a turning frame has constant
/// coordinates.
class MotionMaps {
 public:
  /// Both must outlive this.
  MotionMaps(const Model& model, const DegreesOfFreedom& dof);

  int rows() const { return rows_; }        ///< scalars, as DegreesOfFreedom numbers them
  int columns() const { return columns_; }  ///< coordinates
  /// rows() x columns() at a pose whose slaves stand where their joints have them.
  Eigen::MatrixXd at(const MechanismPose& pose) const;
  /// The unknowns of a step by the coordinates, from at() of the same pose: columns() x columns().
  Eigen::MatrixXd unknowns(const MechanismPose& pose, const Eigen::MatrixXd& maps) const;
  /// How all columns move in a motion that loops allow, by those of the columns `independent` (increasing).
  /// @throws std::runtime_error where the others do not follow from these.
  Eigen::MatrixXd allowed(const MechanismPose& pose, const Eigen::MatrixXd& maps,
                          const std::vector<int>& independent) const;
  /// Which columns loops leave free, and which follow from these, both increasing; driven ones are free before others.
  /// @throws std::runtime_error at a dead point.
  struct Split {
    std::vector<int> independent, dependent;
  };
  Split split(const MechanismPose& pose, const std::vector<bool>& is_driven) const;
  /// Per column: the scalar of DegreesOfFreedom that it is.
  std::vector<int> scalars_of_columns() const;
  /// The slave node that carries the link of a node that is no slave; -1: the world.
  int carrier(int node) const { return carriers_[node]; }
  /// Where the pose is after `time` [s] of a motion with these rates, exact up to the second order of time.
  MechanismPose moved(const MechanismPose& pose, const CoordinateRates& rates, double time) const;
  /// Rows of the constraints that close loops by the columns, from at() of the same pose.
  Eigen::MatrixXd constraints(const MechanismPose& pose, const Eigen::MatrixXd& maps) const;

 private:
  void sort_nodes();

  const Model& model_;
  const DegreesOfFreedom& dof_;
  int rows_, columns_, constraint_count_ = 0;
  std::vector<int> carriers_;  // per node that is no slave: the slave that carries its link, -1: the world
  std::vector<int> order_;     // nodes, masters and carriers before those that follow them
};

/// A matrix along a motion: its value and first two derivatives by time.
struct MovingMatrix {
  Eigen::MatrixXd value, first, second;
};

/// By the central differences of eighth order at the times of `spacing` [s]; 0: all stands still, derivatives are zero.
MovingMatrix along(const std::function<Eigen::MatrixXd(double)>& at_time, double spacing);

}  // namespace flexarm
