#pragma once
/// Maps from the coordinates of a mechanism to the motion of all its parts, and their change along a motion.
/// (docs/notes/linearisation.md 1)

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "joints/kinematics.h"

namespace flexarm {

struct MechanismPose : Configuration {
  std::vector<double> force_memory = {};  ///< as in State: force elements measure by it
};
MechanismPose pose_of(const State& state);
/// A state at this pose, without anything else: for functions that read only poses.
State state_at(const MechanismPose& pose);

/// First and second derivatives of the coordinates along a motion, one entry per column of MotionMaps.
struct CoordinateRates {
  Eigen::VectorXd first, second;
};

/// The variations of all scalars of a mechanism as linear functions of its coordinates. The scalars are {displacement
/// [m], spin [rad]} of every node, and the released coordinates [m, rad]. Displacements are along world axes, spins
/// along the node's own axes. There is one coordinate for each unknown that is no multiplier: those of joints, and
/// {displacement, spin} of nodes relative to the node that carries their link, along its axes. So a motion that is
/// steady in a turning frame has constant coordinates.
class MotionMaps {
 public:
  /// `model` and `dof` must outlive this object.
  MotionMaps(const Model& model, const DegreesOfFreedom& dof);

  int rows() const { return rows_; }        ///< scalars, as DegreesOfFreedom numbers them
  int columns() const { return columns_; }  ///< coordinates
  /// The maps, rows() x columns(), at a pose whose slaves are where their joints place them.
  Eigen::MatrixXd at(const MechanismPose& pose) const;
  /// The unknowns of a step as functions of the coordinates, columns() x columns(). `maps`: at() of the same pose.
  Eigen::MatrixXd unknowns(const MechanismPose& pose, const Eigen::MatrixXd& maps) const;
  /// How all columns move in a motion that loops allow, as a function of the columns `independent` (increasing).
  /// @throws std::runtime_error if these do not determine the other columns.
  Eigen::MatrixXd allowed(const MechanismPose& pose, const Eigen::MatrixXd& maps,
                          const std::vector<int>& independent) const;
  /// Which columns loops leave independent, and which follow from these; both increasing. Driven columns are
  /// independent before others.
  /// @throws std::runtime_error at a dead point.
  struct Split {
    std::vector<int> independent, dependent;
  };
  Split split(const MechanismPose& pose, const std::vector<bool>& is_driven) const;
  /// For each column, its scalar of DegreesOfFreedom.
  std::vector<int> scalars_of_columns() const;
  /// For a node that is no slave, the slave node that carries its link; -1: the world.
  int carrier(int node) const { return carriers_[node]; }
  /// The pose after `time` [s] of a motion that begins at `pose` with these rates, exact up to the second order of
  /// time.
  MechanismPose moved(const MechanismPose& pose, const CoordinateRates& rates, double time) const;
  /// Rows of the loop constraints, divided by their scales, by the columns. `maps`: at() of the same pose.
  Eigen::MatrixXd constraints(const MechanismPose& pose, const Eigen::MatrixXd& maps) const;

 private:
  void sort_nodes();

  const Model& model_;
  const DegreesOfFreedom& dof_;
  int constraint_count_, rows_, columns_;
  std::vector<int> carriers_;  // per node that is no slave: the slave that carries its link, -1: the world
  std::vector<int> order_;     // nodes in an order in which masters and carriers come first
};

/// A matrix along a motion: its value and first two derivatives by time.
struct MovingMatrix {
  Eigen::MatrixXd value, first, second;
};

/// By central differences of eighth order, at times that are multiples of `spacing` [s]. 0: nothing moves, derivatives
/// are zero.
MovingMatrix along(const std::function<Eigen::MatrixXd(double)>& at_time, double spacing);

}  // namespace flexarm
