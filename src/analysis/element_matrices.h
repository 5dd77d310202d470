#pragma once
/// Matrices of an element of a beam for small motions about a configuration at rest, with respect to {displacement,
/// spin} of its nodes. Their sizes are known at run time only, so that code that uses them is compiled once for all
/// orders.

#include <vector>

#include <Eigen/Core>

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

class SparseTangent;

/// Stiffness of the material, without the geometric stiffness.
template <int Nodes>
Eigen::MatrixXd material_stiffness(const BeamElement<Nodes>& element, const State& state);

/// Second derivative of the strain energy by strains alone: the stiffness of the material, tested with variations of
/// strains.
template <int Nodes>
Eigen::MatrixXd material_curvature(const BeamElement<Nodes>& element, const State& state);

/// Variations d{Gamma, K} at all stiffness points, each 6 x 6 Nodes.
template <int Nodes>
std::vector<Eigen::MatrixXd> strain_variations(const BeamElement<Nodes>& element, const State& state);

template <int Nodes>
Eigen::MatrixXd mass_matrix(const BeamElement<Nodes>& element, const State& state);

/// Adds the matrix of an element to `sum`, in which `first` is the element's first block.
void add_element(SparseTangent& sum, std::size_t first, const Eigen::MatrixXd& matrix);

}  // namespace flexarm
