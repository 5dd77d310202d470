#pragma once
/// Invariant subspaces of matrices. In a file of its own, since Eigen's Schur decomposition takes long to compile.

#include <complex>
#include <vector>

#include <Eigen/Core>

namespace flexarm {

/// Bases of two invariant subspaces of a matrix, each of them orthonormal. Together they span the whole space.
struct InvariantSubspaces {
  Eigen::MatrixXd wanted, others;
};
/// Splits the eigenvalues of a matrix. Those next to the `wanted` ones, as many as these, are in the first subspace.
/// `wanted` must contain both eigenvalues of each conjugate pair.
/// @throws std::runtime_error if the eigenvalues are not found
InvariantSubspaces invariant_subspaces(const Eigen::MatrixXd& matrix, const std::vector<std::complex<double>>& wanted);

}  // namespace flexarm
