#pragma once
/// Small motions of a mechanism about a configuration at rest: M x'' + D x' + K x = 0 in its unknowns.

#include <limits>
#include <vector>

#include <Eigen/SparseCore>

#include "analysis/modes.h"
#include "analysis/rotor_motion.h"
#include "integrators/step_system.h"
#include "joints/kinematics.h"
#include "solver/sparse_tangent.h"

namespace flexarm {

/// Work of weight, loads at time 0 and applied wrenches over the model's length scale, or over a rotation by 1 rad [J].
double work_of_forces(const Model& model, const State& equilibrium);

/// Relative round-off of a term of the stiffness. It results from some sixty operations: interpolation, rotations,
/// section, folding, factorisation.
constexpr double kStiffnessRoundOff = 64 * std::numeric_limits<double>::epsilon();
/// Round-off of phi* K phi about an equilibrium [J]: kStiffnessRoundOff times the sum of its terms in absolute value.
double round_off(const Model& model, const State& equilibrium, const std::vector<ComplexVector6>& node_motion);
/// Whether some load has no potential (it follows, or is a moment in space), so that a motion about the equilibrium may
/// gain energy.
bool is_circulatory(const Model& model, const State& equilibrium);
/// The static rule with exact forces and local interpolation.
Scheme exact_equilibrium();

class LinearisedMotion {
 public:
  using Matrix = Eigen::Map<const Eigen::SparseMatrix<double>>;

  /// Linearises about the configuration of `state`, under the loads at time 0. Parts that nothing carries fall along
  /// (see Fall). `model` must outlive this object.
  /// @throws std::runtime_error if the stiffness is not finite.
  LinearisedMotion(const Model& model, const State& state);

  /// Number of unknowns: those of a step, then the rotors behind elastic gears.
  int unknowns() const { return has_rotors() ? static_cast<int>(matrices_.column_starts.size()) - 1 : dof_.unknowns; }
  /// Number of motions that no multiplier of a loop constrains.
  int freedoms() const;
  /// Stiffness, damping and mass have the same sparsity pattern.
  const std::vector<int>& column_starts() const {
    return has_rotors() ? matrices_.column_starts : stiffness_.column_starts();
  }
  const std::vector<int>& row_indices() const {
    return has_rotors() ? matrices_.row_indices : stiffness_.row_indices();
  }
  Matrix stiffness() const { return matrix(matrices_.stiffness, stiffness_); }
  /// The matrix of velocities. It has no gyroscopic terms, since the configuration is at rest.
  Matrix damping() const { return matrix(matrices_.damping, damping_); }
  Matrix mass() const { return matrix(matrices_.mass, mass_); }
  bool is_damped() const;
  bool is_circulatory() const { return flexarm::is_circulatory(model_, state_); }

  /// The second derivative of the potential, with multipliers and with rotors at rest. It is symmetric, but the
  /// stiffness is not: elements are not tested with the variations of their strains. Both differ by the mesh's error.
  Eigen::SparseMatrix<double> curvature() const;

  /// The motion of all nodes and coordinates that belongs to an eigenvector. Does not set frequency and rate.
  Mode expand(const Eigen::VectorXcd& vector) const;
  /// Twice the strain energy of a motion of the nodes [J].
  double strain_energy(const std::vector<ComplexVector6>& node_motion) const;
  double round_off(const std::vector<ComplexVector6>& node_motion) const {
    return flexarm::round_off(model_, state_, node_motion);
  }

 private:
  static Matrix matrix(const SparseTangent& tangent);
  bool has_rotors() const { return !matrices_.column_starts.empty(); }
  /// `extended` if there are rotors, else `own`.
  Matrix matrix(const std::vector<double>& extended, const SparseTangent& own) const;
  void balance();
  void find_multipliers();
  void assemble_damping();

  const Model& model_;
  State state_;  // with the inertia of what falls among its wrenches
  StepSystem system_;
  const DegreesOfFreedom& dof_;
  const SparseTangent& stiffness_;
  SparseTangent damping_, mass_;
  Kinematics kinematics_;
  MotionMatrices matrices_;  // with rotors behind elastic gears; empty if there are none
};

}  // namespace flexarm
