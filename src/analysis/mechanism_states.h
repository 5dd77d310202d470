#pragma once
/// The states of linear models about an instant as functions of the motion. (docs/notes/sensitivities.md 4)

#include <vector>

#include <Eigen/Core>

#include "analysis/linear_dynamics.h"

namespace flexarm {

/// Where a mechanism stands and how fast it moves.
struct MechanismMotion {
  MechanismPose pose;
  KnownRates rates;
  std::vector<double> rotors;  ///< angles, per actuator
};

/// Positions y, those of LinearDynamics that no motion drives, rotors behind elastic gears last, then their rates, seen
/// from a reference.
class MechanismStates {
 public:
  /// @throws std::runtime_error at a dead point.
  MechanismStates(const Model& model, const MechanismMotion& reference);
  MechanismStates(const MechanismStates&) = delete;

  int size() const { return 2 * positions(); }
  /// Scalars of degrees_of_freedom() that the first of y are, and actuators whose rotors the others are.
  const std::vector<int>& scalars() const { return scalars_; }
  const std::vector<int>& rotors() const { return rotors_; }
  const DegreesOfFreedom& degrees_of_freedom() const { return dof_; }
  /// The states of another motion, less those of the reference, up to what is quadratic in how far off it is. The
  /// mechanism may be another one with the same numbering.
  Eigen::VectorXd deviation(const MechanismMotion& motion) const;
  /// The motion whose deviation is `way` in one state and zero in the others, up to what is quadratic.
  MechanismMotion moved(int state, double way) const;

 private:
  /// Per column of MotionMaps: where it is as seen from `reference_`, and its rate.
  Eigen::VectorXd places(const MechanismPose& pose) const;
  Eigen::VectorXd rates(const MechanismMotion& motion) const;
  /// Of columns that are spins: by which their rate differs from the derivative of a small rotation, `turned` from the
  /// reference.
  Eigen::VectorXd turning(const Eigen::VectorXd& turned) const;
  int positions() const { return static_cast<int>(columns_.size() + rotors_.size()); }

  Model model_;  // whose driven coordinates are free
  DegreesOfFreedom dof_;
  MotionMaps maps_;
  MechanismMotion reference_;
  std::vector<int> independent_;        // columns, the driven ones included
  std::vector<int> columns_, scalars_;  // that y are
  std::vector<int> rotors_;             // actuators
  std::vector<int> spins_;              // first of three columns that are the spin of a node or a joint
  Eigen::VectorXd rates_;               // of the reference, per column
};

}  // namespace flexarm
