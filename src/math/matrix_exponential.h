#pragma once
/// Exponentials of square matrices.

#include <Eigen/Core>

namespace flexarm {

/// exp(A) - 1, by a Taylor series of A/2^k and E <- 2 E + E^2 k times: what is small beside the largest entry keeps its
/// digits where the matrix is graded, as it would not if 1 were added.
Eigen::MatrixXd matrix_exponential_less_identity(Eigen::MatrixXd matrix);

}  // namespace flexarm
