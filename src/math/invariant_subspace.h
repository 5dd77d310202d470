#pragma once
/// Invariant subspaces of matrices. In a file of its own, since Eigen's Schur decomposition takes long to compile.

#include <complex>
#include <functional>
#include <vector>

#include <Eigen/Core>

namespace flexarm {

/// Splits the eigenvalues of a matrix into `count` groups. For each group, returns an orthonormal basis of the
/// invariant subspace that belongs to its eigenvalues. `group_of`: 0 to `count` - 1, the same for both eigenvalues of a
/// conjugate pair.
/// @throws std::runtime_error if the eigenvalues are not found
std::vector<Eigen::MatrixXd> invariant_subspaces(const Eigen::MatrixXd& matrix, int count,
                                                 const std::function<int(std::complex<double>)>& group_of);

}  // namespace flexarm
