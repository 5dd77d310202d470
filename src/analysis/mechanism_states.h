#pragma once
/// The states of linear models about an instant as functions of the motion. (docs/notes/sensitivities.md 4)

#include <vector>

#include <Eigen/Core>

#include "analysis/linear_dynamics.h"

namespace flexarm {

/// Pose and rates of a mechanism.
struct MechanismMotion {
  MechanismPose pose;
  KnownRates rates;
  std::vector<double> rotors;  ///< angles, per actuator
};

/// States of a motion relative to a reference: first the positions y, which are those of LinearDynamics that no motion
/// prescribes, with rotors behind elastic gears last. Then the rates of y.
class MechanismStates {
 public:
  /// @throws std::runtime_error at a dead point.
  MechanismStates(const Model& model, const MechanismMotion& reference);
  MechanismStates(const MechanismStates&) = delete;

  int size() const { return 2 * positions(); }
  /// What the positions y are: first these scalars of degrees_of_freedom(), then the rotors of these actuators.
  const std::vector<int>& scalars() const { return scalars_; }
  const std::vector<int>& rotors() const { return rotors_; }
  const DegreesOfFreedom& degrees_of_freedom() const { return dof_; }
  /// The states of another motion minus those of the reference, without terms that are quadratic in the difference. The
  /// motion may be that of another mechanism with the same numbering.
  Eigen::VectorXd deviation(const MechanismMotion& motion) const;
  /// The motion whose deviation is `way` in one state and zero in the others, without quadratic terms.
  MechanismMotion moved(int state, double way) const;

 private:
  /// Per column of MotionMaps: the position relative to `reference_`, and the rate.
  Eigen::VectorXd places(const MechanismPose& pose) const;
  Eigen::VectorXd rates(const MechanismMotion& motion) const;
  /// For columns that are spins: the derivative of a small rotation `turned` from the reference, minus the change of
  /// the spin.
  Eigen::VectorXd turning(const Eigen::VectorXd& turned) const;
  int positions() const { return static_cast<int>(columns_.size() + rotors_.size()); }

  Model model_;  // in which driven coordinates are free
  DegreesOfFreedom dof_;
  MotionMaps maps_;
  MechanismMotion reference_;
  std::vector<int> independent_;        // columns, including driven ones
  std::vector<int> columns_, scalars_;  // of the positions y
  std::vector<int> rotors_;             // actuators
  std::vector<int> spins_;              // first of three columns that are the spin of a node or a joint
  Eigen::VectorXd rates_;               // of the reference, per column
};

}  // namespace flexarm
