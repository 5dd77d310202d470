#pragma once
/// Rotors in small motions about a configuration at rest.

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "integrators/actuators.h"
#include "model/degrees_of_freedom.h"
#include "model/state.h"
#include "solver/sparse_tangent.h"

namespace flexarm {

/// Stiffness K, damping D and mass M by columns, with one sparsity pattern.
struct MotionMatrices {
  std::vector<int> column_starts, row_indices;
  std::vector<double> stiffness, damping, mass;
};

/// What the motor and the spring of a coordinate add to the damping and the mass of its own equation, if the rotor has
/// no angle of its own.
struct ActuatorTerms {
  int joint, component;
  double damping = 0, mass = 0;
  double servo_damping = 0;  ///< of the controller; not contained in `damping`
};
std::vector<ActuatorTerms> actuator_terms(const Model& model, const State& state);

/// The actuators whose rotors have an angle of their own behind elastic gears.
std::vector<int> separate_rotors(const Model& model, const DegreesOfFreedom& dof);

/// Rates that motors and controllers measure.
struct ActuatorRates {
  std::vector<double> coordinates;  ///< per coordinate
  std::vector<double> rotors;       ///< per actuator, of rotors behind elastic gears
};

/// An equilibrium has no rates. So for an instant of a motion, the efforts that controllers demand because of rates and
/// of moving set points become commands to the motors. Limits cut the sum. `frozen`: the model in which time stands
/// still.
void command_by_rates(const Model& model, const ActuatorRates& rates, Model& frozen, State& state);

/// Efforts that the dampers of elastic gears take from each rotor, per actuator [N m or N].
std::vector<double> efforts_of_gear_dampers(const Model& model, const State& state, const ActuatorRates& rates);

/// Entries of K, D and M that rotors behind elastic gears add. Each rotor has a row and a column of its own, from
/// `first` on. The stiffness to which they are added has rotors that follow their coordinates at rest, or are held, as
/// `resting` says.
struct RotorEntries {
  std::vector<Eigen::Triplet<double>> stiffness, damping, mass;
  std::vector<int> actuators;  ///< of the rotors
};
RotorEntries rotor_entries(const Model& model, const DegreesOfFreedom& dof, const State& state,
                           const Actuators& resting, int first);

/// The matrices with one more row and column for each rotor behind an elastic gear, see rotor_entries(). A step solves
/// for these angles inside the joint, but in a free motion they have inertia. Empty if there are no such rotors.
MotionMatrices with_rotors(const Model& model, const DegreesOfFreedom& dof, const State& state,
                           const Actuators& resting, const SparseTangent& stiffness, const SparseTangent& damping,
                           const SparseTangent& mass);

}  // namespace flexarm
