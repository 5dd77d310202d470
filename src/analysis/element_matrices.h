#pragma once
/// Matrices of small motions of a beam's element about a configuration at rest, by {displacement, spin} of its nodes.
/// Their sizes are known at run time only, so that code that uses them is compiled once for all orders.

#include <vector>

#include <Eigen/Core>

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

class SparseTangent;

/// Stiffness of the material alone, without what stress adds to it.
template <int Nodes>
Eigen::MatrixXd material_stiffness(const BeamElement<Nodes>& element, const State& state);

/// Second derivative of the energy by strains alone: the material's stiffness with variations of strains as tests.
template <int Nodes>
Eigen::MatrixXd material_curvature(const BeamElement<Nodes>& element, const State& state);

/// d{Gamma, K} of every stiffness point, 6 x 6 Nodes.
template <int Nodes>
std::vector<Eigen::MatrixXd> strain_variations(const BeamElement<Nodes>& element, const State& state);

template <int Nodes>
Eigen::MatrixXd mass_matrix(const BeamElement<Nodes>& element, const State& state);

/// Adds the matrix of the element whose first block is `first`.
void add_element(SparseTangent& sum, std::size_t first, const Eigen::MatrixXd& matrix);

}  // namespace flexarm
