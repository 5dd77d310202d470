#pragma once
/// Sums over all parts of a mechanism in a tangent, for small motions about a configuration.

#include "joints/kinematics.h"
#include "solver/sparse_tangent.h"

namespace flexarm {

/// The diagonal entry of a released coordinate.
double& diagonal_entry(const Kinematics& kinematics, SparseTangent& sum, int joint, int component);

/// Adds the mass matrix of nodes and coordinates, before slaves are folded. Of the rotors it contains those that turn
/// with their coordinates.
void add_mass(const Kinematics& kinematics, const State& state, SparseTangent& mass);

/// Folds slaves into their masters, and coordinates that follow others into these.
void fold(const Kinematics& kinematics, SparseTangent& sum);

}  // namespace flexarm
