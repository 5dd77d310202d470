#pragma once
/// Kept in a file of its own: Eigen's Schur decomposition takes long to compile.

#include <complex>
#include <functional>

#include <Eigen/Core>

namespace flexarm {

/// An orthonormal basis of what a matrix maps into itself with the eigenvalues that are `wanted`, and no others. Of a
/// conjugate pair both or none are to be wanted.
/// @throws std::runtime_error if the eigenvalues are not found
Eigen::MatrixXd invariant_subspace(const Eigen::MatrixXd& matrix,
                                   const std::function<bool(std::complex<double>)>& wanted);

}  // namespace flexarm
