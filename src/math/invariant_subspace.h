#pragma once
/// Invariant subspaces of matrices. In a file of its own, since Eigen's Schur decomposition takes long to compile.

#include <complex>
#include <functional>

#include <Eigen/Core>

namespace flexarm {

/// Returns an orthonormal basis of the invariant subspace of a matrix that belongs to the eigenvalues that are
/// `wanted`. `wanted` must be the same for both eigenvalues of a conjugate pair.
/// @throws std::runtime_error if the eigenvalues are not found
Eigen::MatrixXd invariant_subspace(const Eigen::MatrixXd& matrix,
                                   const std::function<bool(std::complex<double>)>& wanted);

}  // namespace flexarm
