#pragma once
/// How far inputs move the states of x' = a x + b u, and how far outputs c x see them.

#include <Eigen/Core>

namespace flexarm {

/// Square roots of the solutions P, Q of the equations of Lyapunov  a P + P a^T + b b^T = 0,  a^T Q + Q a + c^T c = 0.
struct GramianRoots {
  Eigen::MatrixXd reached;  ///< P = reached reached^T
  Eigen::MatrixXd seen;     ///< Q = seen^T seen
};
/// By Newton's iteration for the sign of a, which all eigenvalues of a take to -1 (Benner and Quintana-Orti 1999). The
/// real parts of all eigenvalues are < 0.
/// @throws std::runtime_error if the iteration does not converge
GramianRoots gramian_roots(Eigen::MatrixXd a, const Eigen::MatrixXd& b, const Eigen::MatrixXd& c);

}  // namespace flexarm
