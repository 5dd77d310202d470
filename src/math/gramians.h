#pragma once
/// Gramians of a linear system x' = a x + b u, y = c x: how strongly inputs move its states, and outputs depend on
/// them.

#include <Eigen/Core>

namespace flexarm {

/// Square roots of the controllability Gramian P and the observability Gramian Q, which are the solutions of the
/// Lyapunov equations  a P + P a^T + b b^T = 0,  a^T Q + Q a + c^T c = 0.
struct GramianRoots {
  Eigen::MatrixXd reached;  ///< P = reached reached^T
  Eigen::MatrixXd seen;     ///< Q = seen^T seen
};
/// Computes the square roots by Newton's iteration for the matrix sign function of a, in which all eigenvalues of a
/// converge to -1 (Benner and Quintana-Orti 1999). All eigenvalues of a must have real parts < 0.
/// @throws std::runtime_error if the iteration does not converge
GramianRoots gramian_roots(Eigen::MatrixXd a, const Eigen::MatrixXd& b, const Eigen::MatrixXd& c);

}  // namespace flexarm
