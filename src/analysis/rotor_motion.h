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

/// K, D and M by columns, in one pattern.
struct MotionMatrices {
  std::vector<int> column_starts, row_indices;
  std::vector<double> stiffness, damping, mass;
};

/// What motors and springs of coordinates add to the damping and the mass of their own equations, where their rotors
/// have no angle of their own.
struct ActuatorTerms {
  int joint, component;
  double damping = 0, mass = 0;
  double servo_damping = 0;  ///< of the controller, beside the other
};
std::vector<ActuatorTerms> actuator_terms(const Model& model, const State& state);

/// The actuators whose rotors have an angle of their own behind elastic gears.
std::vector<int> separate_rotors(const Model& model, const DegreesOfFreedom& dof);

/// Rates of what motors and controllers measure.
struct ActuatorRates {
  std::vector<double> coordinates;  ///< per coordinate
  std::vector<double> rotors;       ///< per actuator, of rotors behind elastic gears
};

/// An equilibrium knows no rates: for a motion's instant what controllers ask for because of them, and set points that
/// move, become commands to the motors. Limits cut the sum. `frozen`: the model in which time stands still.
void command_by_rates(const Model& model, const ActuatorRates& rates, Model& frozen, State& state);

/// What the dampers of elastic gears take from each rotor, per actuator [N m or N].
std::vector<double> efforts_of_gear_dampers(const Model& model, const State& state, const ActuatorRates& rates);

/// What rotors behind elastic gears, each with a row and a column of its own from `first` on, add to K, D and M,
/// where the stiffness has them follow their coordinates at rest, or hold them, as `resting` says.
struct RotorEntries {
  std::vector<Eigen::Triplet<double>> stiffness, damping, mass;
  std::vector<int> actuators;  ///< of the rotors
};
RotorEntries rotor_entries(const Model& model, const DegreesOfFreedom& dof, const State& state,
                           const Actuators& resting, int first);

/// The matrices with one row and column more for each rotor behind an elastic gear, whose angles a step solves for
/// inside the joint: in a free motion they have inertia; see rotor_entries(). Empty where there are none.
MotionMatrices with_rotors(const Model& model, const DegreesOfFreedom& dof, const State& state,
                           const Actuators& resting, const SparseTangent& stiffness, const SparseTangent& damping,
                           const SparseTangent& mass);

}  // namespace flexarm
