#pragma once
/// Exponentials of square matrices.

#include <Eigen/Core>

namespace flexarm {

/// Returns exp(A) - 1, by a Taylor series of A/2^k and E <- 2 E + E^2, repeated k times. In graded matrices, entries
/// that are much smaller than the largest one stay accurate, which they would not if 1 were added.
Eigen::MatrixXd matrix_exponential_less_identity(Eigen::MatrixXd matrix);

}  // namespace flexarm
