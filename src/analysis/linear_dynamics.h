#pragma once
/// Small motions of a mechanism about any motion: M y'' + C y' + K y = forces. (docs/notes/linearisation.md)

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "analysis/nodal_dynamics.h"
#include "analysis/rotor_motion.h"
#include "integrators/step_system.h"

namespace flexarm {

/// The motion about which a mechanism is linearised.
enum class Reference {
  Rest,    ///< the configuration as it is, without velocities, under the loads at time 0; what nothing carries falls
  Steady,  ///< driven joints move as at time 0; the others stand still where loads at time 0 balance
  Instant  ///< the motion as it is
};

/// The rates of a motion.
struct KnownRates : ActuatorRates {
  std::vector<Vector6> nodes;  ///< {v, w}, world axes
};

/// The continuous equations of motion of the nodes, linearised. The coordinates y are those of MotionMaps that loops
/// leave independent, including driven joints, and then the rotors behind elastic gears.
class LinearDynamics {
 public:
  /// `rates`: used if the reference is an instant.
  /// @throws std::runtime_error if a steady motion is not found, or if masses leave an acceleration undetermined.
  LinearDynamics(const Model& model, const State& state, const Scheme& scheme, Reference reference,
                 const KnownRates& rates);

  const DegreesOfFreedom& degrees_of_freedom() const { return dof_; }
  /// The state to which y refers: in steady motion it differs from the given state.
  const State& state() const { return state_; }
  int size() const { return static_cast<int>(independent_.size() + rotors_.size()); }
  /// What the coordinates y are: first these scalars of DegreesOfFreedom, then the rotors of these actuators.
  const std::vector<int>& scalars() const { return scalars_; }
  const std::vector<int>& rotors() const { return rotors_; }
  bool is_driven(int coordinate) const { return is_driven_[coordinate]; }

  const Eigen::MatrixXd& mass() const { return mass_; }
  const Eigen::MatrixXd& damping() const { return damping_; }  ///< gyroscopic terms included
  const Eigen::MatrixXd& stiffness() const { return stiffness_; }
  /// Round-off of the diagonal of the stiffness for coordinates that move whole bodies, whose strains cancel; 0 for
  /// others.
  Eigen::VectorXd stiffness_round_off() const;
  /// The force by which the reference is out of balance. It is zero except for driven coordinates, where it is the
  /// driving effort.
  const Eigen::VectorXd& residual() const { return residual_; }
  /// y' and y'' of the reference.
  const Eigen::VectorXd& rates() const { return rates_.first; }
  const Eigen::VectorXd& accelerations() const { return rates_.second; }

  /// Rates and accelerations of all coordinates of MotionMaps, including those that loops determine.
  const CoordinateRates& rates_of_columns() const { return columns_; }

  /// A linear map of motions, and its derivatives along the reference, with respect to the coordinates y without
  /// rotors. `rows` returns the map at a pose, from the motion of the rows of MotionMaps there.
  using Rows = std::function<Eigen::MatrixXd(const MechanismPose& pose, const Eigen::MatrixXd& motion)>;
  MovingMatrix along_reference(const Rows& rows) const;

 private:
  Eigen::VectorXd coordinates_of(const KnownRates& known) const;
  void choose_independent();
  /// Sets the maps along a motion with these y' and y''.
  void set_motion(const Eigen::VectorXd& rates, const Eigen::VectorXd& accelerations);
  void put_dampers_stress(const std::vector<Stretch>& stretches, const Eigen::VectorXd& speeds);
  void put_loads(const Eigen::VectorXd& force);
  /// Finds the balance of the mechanism at rest under the forces of inertia, with the multipliers that close loops
  /// best. `efforts`: efforts of inertia and dampers on coordinates, which `system_` does not contain [N m or N].
  void balance(const Eigen::VectorXd& efforts);
  void assemble();
  ActuatorRates actuator_rates(const Eigen::VectorXd& rows) const;
  void move_to_steady(const Eigen::VectorXd& rates);
  void move(const Eigen::VectorXd& increment);
  Eigen::VectorXd free_accelerations() const;
  void add_rotors(Reference reference);
  std::vector<int> free_places() const;

  Model model_;  // in which time stands still, and driven coordinates are free
  BeamGroups undamped_;
  State state_;
  std::vector<NodalLoad> wrenches_;
  std::vector<bool> is_driven_;  // per coordinate
  StepSystem system_;
  const DegreesOfFreedom& dof_;
  MotionMaps maps_;
  std::vector<int> independent_, dependent_, scalars_, rotors_;
  std::vector<bool> is_driven_place_;  // per independent column
  std::vector<double> rotor_rates_;    // per actuator, at an instant

  // ---- of the reference
  MechanismPose pose_;
  CoordinateRates columns_;        // of all columns
  CoordinateRates rates_;          // of y
  double spacing_ = 0;             // time between the poses of differences along it [s]
  MovingMatrix allowed_, motion_;  // columns and rows of MotionMaps, derivatives by y
  Eigen::MatrixXd tangent_, row_maps_, unknowns_;
  Eigen::MatrixXd mass_, damping_, stiffness_;
  Eigen::VectorXd residual_;
};

}  // namespace flexarm
